#include <weave/core/text.hpp>
#include <weave/diff/node_diff.hpp>

#include <algorithm>

namespace weave {

namespace {

std::string times_in_words(const TileOperation& tile) {
    std::string text;
    const auto add = [&](std::size_t times, const char* way) {
        if (times > 1) text += (text.empty() ? "" : ", ") + std::to_string(times) + " times " + way;
    };
    add(tile.x, "along the warp");
    add(tile.y, "along the weft");
    add(tile.z, "in height");
    return text.empty() ? "once" : text;
}

const char* face_in_words(Face face) {
    constexpr const char* words[]{"after the last row",
                                  "before the first row",
                                  "after the last column",
                                  "before the first column",
                                  "on top",
                                  "below"};
    return words[static_cast<std::size_t>(face)];
}

std::string words_of(const StacksLeaf& leaf) {
    return "stacks, " + counted(leaf.block->rows(), "row") + " and " +
           counted(leaf.block->columns(), "column");
}
std::string words_of(const CardLeaf& leaf) {
    return "a card of " + counted(leaf.card->picks(), "pick") + " and " + counted(leaf.card->ends(), "end");
}
std::string words_of(const PresetLeaf& leaf) {
    std::string text = "the preset " + in_quotes(leaf.preset.family);
    for (const auto& [name, value] : leaf.preset.options)
        text += " " + on_one_line(name) + "=" + std::to_string(value);
    return text;
}
std::string words_of(const SliceLeaf& leaf) {
    return std::string("a ") + (leaf.slice.dots == System::weft ? "warp" : "weft") + " slice of " +
           counted(leaf.slice.positions.size(), "position");
}
std::string words_of(const TileOperation& tile) {
    return in_quotes(tile.of) + " repeated " + times_in_words(tile);
}
std::string words_of(const AttachOperation& attach) {
    return in_quotes(attach.other) + " attached to " + in_quotes(attach.of) + " " +
           face_in_words(attach.face);
}
std::string words_of(const StencilOperation& stencil) {
    return "a stencil of " + counted(stencil.of.size(), "block") + ", " + counted(stencil.map->rows, "row") +
           " and " + counted(stencil.map->columns, "column");
}
std::string words_of(const RenumberOperation& renumber) {
    std::string order;
    constexpr std::size_t most = 12;
    for (std::size_t k = 0; k < std::min(most, renumber.order.size()); ++k)
        order += (k > 0 ? ", " : "") + std::to_string(renumber.order[k] + 1);
    if (renumber.order.size() > most) order += " ...";
    const bool weft = renumber.system == System::weft;
    return in_quotes(renumber.of) + " with the " + (weft ? "picks of row " : "ends of column ") +
           std::to_string(renumber.line + 1) + " in the order " + order;
}

}  // namespace

const std::string& kind_of(const Node& node) {
    static const std::string kinds[]{"stacks", "card",   "preset",  "slice",
                                     "tile",   "attach", "stencil", "renumber"};
    return kinds[node.source.index()];
}

std::string in_words(const Node& node) {
    const std::string text = std::visit([](const auto& source) { return words_of(source); }, node.source);
    return node.flips.empty() ? text : text + ", with " + counted(node.flips.size(), "flip");
}

std::string in_words(const Flip& flip) {
    return "pick " + std::to_string(flip.pick + 1) + ", end " + std::to_string(flip.end + 1) + ": weft " +
           (flip.weft_over ? "over" : "under");
}

}  // namespace weave
