#include <weave/design/extent_to_be.hpp>

#include <weave/block/operation_checks.hpp>

#include <algorithm>

namespace weave {

namespace {

using Extents = std::vector<Extent>;

Extent to_be(const StacksLeaf& leaf, const Extents&) {
    return extent_of(*leaf.block);
}

/// Its cells as many as there may be, one for each crossing.
Extent to_be(const CardLeaf& leaf, const Extents&) {
    return {leaf.card->picks(), leaf.card->ends(), leaf.card->picks(), leaf.card->ends(), 0, 0, 0};
}

Extent to_be(const PresetLeaf&, const Extents&) {
    return {};
}

Extent to_be(const SliceLeaf&, const Extents&) {
    return {};
}

Extent to_be(const TileOperation& operation, const Extents& children) {
    const Extent& one = children[0];
    const auto& [of, x, y, z] = operation;
    if (!check_tile(one, x, y, z)) return {};
    const std::size_t height = one.height * z;
    return {one.rows * x, one.columns * y, one.picks * x * z,  one.ends * y * z,
            height,       one.stacks,      one.stacks * height};
}

Extent to_be(const AttachOperation& operation, const Extents& children) {
    const Extent &one = children[0], &other = children[1];
    Extent both{one.rows,
                one.columns,
                one.picks,
                one.ends,
                std::max(one.height, other.height),
                one.stacks + other.stacks,
                one.slots + other.slots};
    switch (operation.face) {
        case Face::plus_x:
        case Face::minus_x:
            if (one.columns != other.columns) return {};
            both.rows += other.rows, both.picks += other.picks;
            return both;
        case Face::plus_y:
        case Face::minus_y:
            if (one.rows != other.rows) return {};
            both.columns += other.columns, both.ends += other.ends;
            return both;
        default:
            both.picks += other.picks, both.ends += other.ends;
            both.height = one.height + other.height;
            both.stacks = std::min(one.cells(), one.stacks * other.stacks);
            both.slots = std::min(both.stacks * both.height, most_slots);
            return both;
    }
}

Extent to_be(const StencilOperation& operation, const Extents& children) {
    Extent all{operation.map->rows, operation.map->columns, 0, 0, 0, 0, 0};
    for (const Extent& child : children) {
        all.height = std::max(all.height, child.height);
        all.stacks += child.stacks, all.slots += child.slots;
    }
    return all;
}

/// Each stack of the line may come to stand beside the one that it was.
Extent to_be(const RenumberOperation& operation, const Extents& children) {
    Extent same = children[0];
    const std::size_t line = operation.system == System::weft ? same.columns : same.rows;
    const std::size_t added = std::min(line, same.stacks);
    same.slots += std::min(same.slots, added * same.height);
    same.stacks += added;
    return same;
}

/// What does not depend on how many stacks there are.
Status fit(const TileOperation& operation, const std::vector<SizedPart>& children) {
    const BlockGrid& grid = *children[0].grid;
    return check_tile({grid.rows(), grid.columns(), grid.picks(), grid.ends(), children[0].height, 0, 0},
                      operation.x, operation.y, operation.z);
}

Status fit(const AttachOperation& operation, const std::vector<SizedPart>& children) {
    const std::string names[] = {operation.of, operation.other};
    return check_attach({*children[0].grid, children[0].height}, {*children[1].grid, children[1].height},
                        operation.face, names);
}

Status fit(const RenumberOperation& operation, const std::vector<SizedPart>& children) {
    return check_renumber(*children[0].grid, operation.system, operation.line, operation.order);
}

template <class Other>
Status fit(const Other&, const std::vector<SizedPart>&) {
    return {};
}

}  // namespace

Status check_counts_fit(const NodeSource& source, const std::vector<SizedPart>& children) {
    return std::visit([&](const auto& one) { return fit(one, children); }, source);
}

Extent extent_to_be(const NodeSource& source, const std::vector<Extent>& children) {
    return std::visit([&](const auto& one) { return to_be(one, children); }, source);
}

std::size_t needed_for(const Node& node, const std::vector<Extent>& children) {
    const std::size_t once = extent_to_be(node.source, children).units();
    return node.flips.empty() ? once : 2 * once;  // as FORMAT.md counts it
}

}  // namespace weave
