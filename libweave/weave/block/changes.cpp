#include <weave/block/changes.hpp>

#include <unordered_map>
#include <utility>

namespace weave {

namespace {

/// Flips one crossing that lies otherwise than in `goal`, and can be flipped alone; nothing where all lie so.
/// There is one as long as any differs: of the two yarns that differ with the fewest yarns between them, those
/// between are first of the lower one's system and then of the upper one's.
std::optional<Flip> flip_towards(Stack& stack, const Stack& goal) {
    for (std::size_t weft = 0; weft < stack.wefts(); ++weft) {
        for (std::size_t warp = 0; warp < stack.warps(); ++warp) {
            const bool over = goal.weft_over(weft, warp);
            if (stack.weft_over(weft, warp) == over) continue;
            FlippedStack flipped = flip(stack, weft, warp);
            if (!flipped.valid) continue;
            stack = std::move(flipped.stack);
            return Flip{weft, warp, over};
        }
    }
    return {};
}

}  // namespace

std::optional<std::vector<std::size_t>> changed_cells(const Block& before, const Block& after) {
    if (!(before.grid() == after.grid())) return {};
    // Stacks are compared once a pair of table entries, of which there are few.
    std::unordered_map<std::uint64_t, bool> differs;
    const auto old_cells = before.cells(), new_cells = after.cells();
    std::vector<std::size_t> changed;
    std::uint64_t last_pair = ~std::uint64_t{0};
    bool last_differs = false;
    for (std::size_t cell = 0; cell < old_cells.size(); ++cell) {
        const std::uint64_t pair = std::uint64_t{old_cells[cell]} << 32 | new_cells[cell];
        if (pair != last_pair) {
            const auto [found, is_new] = differs.try_emplace(pair, false);
            if (is_new) found->second = !(before.stacks()[old_cells[cell]] == after.stacks()[new_cells[cell]]);
            last_pair = pair;
            last_differs = found->second;
        }
        if (last_differs) changed.push_back(cell);
    }
    return changed;
}

std::optional<std::vector<Flip>> flips_between(const Block& before, const Block& after, std::size_t most) {
    const auto changed = changed_cells(before, after);
    if (!changed) return {};
    std::vector<Flip> flips;
    for (const std::size_t cell : *changed) {
        const std::size_t row = cell / before.columns(), column = cell % before.columns();
        Stack stack = before.stack(row, column);
        while (const auto flip = flip_towards(stack, after.stack(row, column))) {
            if (flips.size() == most) return {};
            flips.push_back({before.first_pick(row) + flip->pick, before.first_end(column) + flip->end, flip->weft_over});
        }
    }
    return flips;
}

}  // namespace weave
