#include "small_cloth.hpp"

#include <weave/design/tree.hpp>

#include <algorithm>
#include <charconv>
#include <map>

namespace weave::fuzz {

namespace {

/// What a node asks for, from above.
struct Size {
    std::uint64_t rows = 1, columns = 1, picks = 1, ends = 1, height = 1;

    [[nodiscard]] bool small() const {
        for (const std::uint64_t one : {rows, columns, picks, ends, height}) {
            if (one > most_small_slots) return false;  // so that the products below fit
        }
        return rows * columns <= most_small_cells && picks * ends <= most_small_crossings &&
               rows * columns * std::max(height, std::uint64_t{1}) <= most_small_slots;
    }
};

Size size_of(const Block& block) {
    return {block.rows(), block.columns(), block.picks(), block.ends(), block.height()};
}

/// Sizes of what the blocks below a node came to, in the order of children_of().
using Children = std::vector<Size>;

Size asked(const StacksLeaf& leaf, const Children&) {
    return size_of(*leaf.block);
}
Size asked(const CardLeaf& leaf, const Children&) {
    const std::uint64_t picks = leaf.card->picks(), ends = leaf.card->ends();
    return {picks, ends, picks, ends, 1};
}
Size asked(const PresetLeaf& leaf, const Children&) {
    std::uint64_t yarns = 1;
    for (const auto& [name, value] : leaf.preset.options) {
        yarns *= static_cast<std::uint64_t>(std::clamp<std::int64_t>(value, 1, 1 << 10));
        yarns = std::min<std::uint64_t>(yarns, most_small_slots);
    }
    return {yarns, 1, yarns, 1, yarns};
}
Size asked(const SliceLeaf& leaf, const Children&) {
    Size size;
    for (const auto& position : leaf.slice.positions)
        size.height = std::max<std::uint64_t>(size.height, position.size());
    size.rows = size.picks = leaf.slice.positions.size();
    return size;
}
Size asked(const TileOperation& tile, const Children& children) {
    Size size = children[0];
    for (const std::uint64_t times : {tile.x, tile.y, tile.z}) {
        if (times > most_small_slots) return {times};
    }
    size.rows *= tile.x;
    size.columns *= tile.y;
    size.picks *= tile.x * tile.z;
    size.ends *= tile.y * tile.z;
    size.height *= tile.z;
    return size;
}
Size asked(const AttachOperation&, const Children& children) {
    const Size &a = children[0], &b = children[1];
    return {a.rows + b.rows, a.columns + b.columns, a.picks + b.picks, a.ends + b.ends, a.height + b.height};
}
Size asked(const StencilOperation& stencil, const Children& children) {
    Size size{stencil.map->rows, stencil.map->columns, stencil.map->rows, stencil.map->columns, 1};
    std::uint64_t picks = 1, ends = 1;  // of any one cell
    for (const Size& child : children) {
        picks = std::max(picks, child.picks);
        ends = std::max(ends, child.ends);
        size.height = std::max(size.height, child.height);
    }
    if (!size.small()) return size;
    size.picks *= picks;
    size.ends *= ends;
    return size;
}
Size asked(const RenumberOperation&, const Children& children) {
    return children[0];
}

}  // namespace

std::optional<Evaluation> small_cloth(const Design& design) {
    Evaluator evaluator;
    std::map<std::string, Size> sizes;
    for (const std::string& name : bottom_up(design, design.root)) {
        const Node& node = *design.blocks.at(name);
        Children children;
        for (const std::string& child : children_of(node)) children.push_back(sizes.at(child));
        const Size size =
            std::visit([&](const auto& source) { return asked(source, children); }, node.source);
        if (!size.small()) return {};
        const auto made = evaluator.evaluate(design, name);
        if (!made) return {};
        sizes[name] = size_of(*made->block);
    }
    auto cloth = evaluator.evaluate(design);
    if (!cloth) return {};
    return std::move(cloth).value();
}

bool runs_are_short(std::string_view text) {
    constexpr std::uint64_t most = std::uint64_t{1} << 20;
    std::uint64_t sum = 0;
    for (std::size_t at = 0; (at = text.find('*', at)) != std::string_view::npos;) {
        ++at;
        std::uint32_t count = 0;
        std::from_chars(text.data() + at, text.data() + text.size(), count);
        if (count <= longest_sequence) sum += count;  // longer ones are refused before anything is allocated
    }
    return sum <= most;
}

}  // namespace weave::fuzz
