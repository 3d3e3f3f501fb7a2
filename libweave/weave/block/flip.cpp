#include <weave/block/flip.hpp>

#include <algorithm>

namespace weave {

namespace {

std::string named(const std::vector<Slot>& yarns, std::size_t first_pick, std::size_t first_end) {
    std::string text;
    for (const Slot yarn : yarns) {
        if (!text.empty()) text += ", ";
        text += yarn.is_weft() ? "pick " + std::to_string(first_pick + yarn.index() + 1)
                               : "end " + std::to_string(first_end + yarn.index() + 1);
    }
    return text;
}

/// Whether the weft stands above the warp; both in the stack.
bool lies_over(const Stack& stack, std::size_t weft, std::size_t warp) {
    for (const Slot slot : stack.slots()) {
        if (slot.is_warp() && slot.index() == warp) return true;
        if (slot.is_weft() && slot.index() == weft) return false;
    }
    return false;
}

}  // namespace

FlippedStack flip(const Stack& stack, std::size_t weft, std::size_t warp) {
    std::vector<Slot> yarns;
    for (const Slot slot : stack.slots()) {
        if (!slot.is_empty()) yarns.push_back(slot);
    }
    const auto place_of = [&](Slot yarn) {
        const auto found = std::find_if(yarns.begin(), yarns.end(), [&](Slot other) {
            return other.same_system(yarn) && other.index() == yarn.index();
        });
        assert(found != yarns.end());
        return static_cast<std::size_t>(found - yarns.begin());
    };
    std::size_t bottom = place_of(Slot::weft(weft)), top = place_of(Slot::warp(warp));
    if (bottom > top) std::swap(bottom, top);
    while (top > 0 && yarns[top].same_system(yarns[top - 1])) std::swap(yarns[top], yarns[top - 1]), --top;
    while (bottom + 1 < yarns.size() && yarns[bottom].same_system(yarns[bottom + 1])) {
        std::swap(yarns[bottom], yarns[bottom + 1]), ++bottom;
    }
    if (top != bottom + 1) {
        std::vector<Slot> between(yarns.begin() + static_cast<std::ptrdiff_t>(bottom) + 1,
                                  yarns.begin() + static_cast<std::ptrdiff_t>(top));
        return {false, stack, std::move(between)};
    }
    std::swap(yarns[top], yarns[bottom]);
    std::vector<Slot> slots(stack.slots().begin(), stack.slots().end());
    auto next = yarns.begin();
    for (Slot& slot : slots) {
        if (!slot.is_empty()) slot = *next++;
    }
    return {true, Stack(std::move(slots)), {}};
}

FlippedBlock apply_flips(const Block& block, std::span<const Flip> flips) {
    StackTable table;
    std::vector<std::uint32_t> moved;
    for (const Stack& stack : block.stacks()) moved.push_back(table.number_of(stack));
    std::vector<std::uint32_t> cells;
    cells.reserve(block.cells().size());
    for (const std::uint32_t cell : block.cells()) cells.push_back(moved[cell]);

    std::vector<RefusedFlip> refused;
    for (const Flip& wish : flips) {
        const std::string pair =
            "pick " + std::to_string(wish.pick + 1) + " and end " + std::to_string(wish.end + 1);
        if (wish.pick >= block.picks() || wish.end >= block.ends()) {
            refused.push_back({wish, "there is no crossing of " + pair + ": the block has " +
                                         std::to_string(block.picks()) + " picks and " +
                                         std::to_string(block.ends()) + " ends"});
            continue;
        }
        const std::size_t row = block.row_of_pick(wish.pick), column = block.column_of_end(wish.end);
        const std::size_t first_pick = block.first_pick(row), first_end = block.first_end(column);
        std::uint32_t& cell = cells[row * block.columns() + column];
        const Stack stack = table.at(cell);
        if (lies_over(stack, wish.pick - first_pick, wish.end - first_end) == wish.weft_over) continue;
        FlippedStack flipped = flip(stack, wish.pick - first_pick, wish.end - first_end);
        if (flipped.valid) {
            cell = table.number_of(std::move(flipped.stack));
        } else {
            refused.push_back({wish, pair + " cannot be flipped alone: in the way stand " +
                                         named(flipped.in_the_way, first_pick, first_end)});
        }
    }
    Result<Block> made =
        Block::make(block.t(), block.p(), std::move(table).take(), std::move(cells), block.height());
    assert(made);  // a flip only exchanges yarns within their stack
    return {std::move(made).value(), std::move(refused)};
}

Result<Block> flip(const Block& block, std::size_t pick, std::size_t end) {
    const bool inside = pick < block.picks() && end < block.ends();
    const Flip wish{pick, end, inside && !block.weft_over(pick, end)};
    FlippedBlock flipped = apply_flips(block, std::span(&wish, 1));
    if (flipped.refused.empty()) return std::move(flipped.block);
    std::string& reason = flipped.refused.front().reason;
    return inside ? invalid(std::move(reason)) : bad_input(std::move(reason));
}

}  // namespace weave
