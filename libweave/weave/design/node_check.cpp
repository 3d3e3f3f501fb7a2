#include <weave/core/text.hpp>
#include <weave/design/design.hpp>

#include <algorithm>

namespace weave {

namespace {

constexpr auto most_number = static_cast<std::size_t>(most_yarn_number);

Status check_source(const StacksLeaf& leaf) {
    return leaf.block ? Status() : bad_input("has no stacks", "stacks");
}

Status check_counts(const std::vector<std::uint32_t>& counts, const std::string& where) {
    if (counts.empty()) return bad_input("needs at least one number", where);
    for (std::size_t k = 0; k < counts.size(); ++k) {
        if (counts[k] > most_number)
            return bad_input("must be from 0 to " + std::to_string(most_number), indexed(where, k));
    }
    return {};
}

Status check_source(const CardLeaf& leaf) {
    if (!leaf.card) return bad_input("has no card image", "card");
    if (Status fits = check_card_size(leaf.card->picks(), leaf.card->ends()); !fits)
        return std::move(fits).error().under("card");
    WEAVE_CHECK_OK(check_counts(leaf.t, "t"));
    return check_counts(leaf.p, "p");
}

/// Whether the family and its options exist is known only when the weave is made.
Status check_source(const PresetLeaf& leaf) {
    const Preset& preset = leaf.preset;
    if (preset.family.size() > longest_family || !is_utf8(preset.family))
        return bad_input("must be a text of at most " + std::to_string(longest_family) + " bytes", "family");
    if (preset.options.size() > most_blocks) return bad_input("are too many", "options");
    for (const auto& [name, value] : preset.options) {
        if (!is_utf8(name)) return bad_input("has a name that is not UTF-8", "options");
        if (value < -most_option || value > most_option) {
            return bad_input(
                "must be from " + std::to_string(-most_option) + " to " + std::to_string(most_option),
                "options." + name);
        }
    }
    return {};
}

Status check_source(const SliceLeaf&) {
    return {};
}

Status check_source(const TileOperation& tile) {
    const std::pair<const char*, std::size_t> counts[] = {{"x", tile.x}, {"y", tile.y}, {"z", tile.z}};
    for (const auto& [where, count] : counts) {
        if (count < 1 || count > most_times)
            return bad_input("must be from 1 to " + std::to_string(most_times), where);
    }
    return {};
}

Status check_source(const AttachOperation& attach) {
    if (static_cast<std::size_t>(attach.face) < face_names().size()) return {};
    return bad_input("is no face of a block", "face");
}

Status check_source(const StencilOperation& stencil) {
    if (stencil.of.empty() || stencil.of.size() > most_stencilled)
        return bad_input("must be a list of 1 to " + std::to_string(most_stencilled) + " block names", "of");
    if (!stencil.map) return bad_input("is missing", "map");
    const StencilMap& map = *stencil.map;
    if (Status fits = check_card_size(map.rows, map.columns); !fits)
        return std::move(fits).error().under("map");
    if (map.columns > longest_sequence)
        return bad_input("has rows longer than " + std::to_string(longest_sequence) + " stacks", "map");
    if (map.blocks.size() != map.rows * map.columns)
        return bad_input("must have an entry for each of its rows and columns", "map");
    const auto wrong = std::find_if(map.blocks.begin(), map.blocks.end(),
                                    [&](std::uint16_t number) { return number >= stencil.of.size(); });
    if (wrong == map.blocks.end()) return {};
    return bad_input("names number " + std::to_string(*wrong) + ", but there are only " +
                         std::to_string(stencil.of.size()) + ", counted from 0",
                     indexed("map", static_cast<std::size_t>(wrong - map.blocks.begin()) / map.columns));
}

Status check_source(const RenumberOperation& renumber) {
    const char* const line = renumber.system == System::weft ? "row" : "column";
    if (renumber.line > most_number)
        return bad_input("must be from 0 to " + std::to_string(most_number), line);
    for (std::size_t k = 0; k < renumber.order.size(); ++k) {
        if (renumber.order[k] > most_number)
            return bad_input("must be from 0 to " + std::to_string(most_number), indexed("order", k));
    }
    return {};
}

}  // namespace

Status check(const Node& node) {
    WEAVE_CHECK_OK(std::visit([](const auto& source) { return check_source(source); }, node.source));
    for (std::size_t k = 0; k < node.flips.size(); ++k) {
        if (node.flips[k].pick > most_number || node.flips[k].end > most_number)
            return bad_input("names a crossing that no cloth has", indexed("flips", k));
    }
    return {};
}

}  // namespace weave
