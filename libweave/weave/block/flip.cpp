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

Result<Block> flip(const Block& block, std::size_t pick, std::size_t end) {
    const std::string pair = "pick " + std::to_string(pick + 1) + " and end " + std::to_string(end + 1);
    if (pick >= block.picks() || end >= block.ends()) {
        return invalid("there is no crossing of " + pair + ": the block has " + std::to_string(block.picks()) +
                       " picks and " + std::to_string(block.ends()) + " ends");
    }
    const std::size_t row = block.row_of_pick(pick), column = block.column_of_end(end);
    const std::size_t first_pick = block.first_pick(row), first_end = block.first_end(column);
    const FlippedStack flipped = flip(block.stack(row, column), pick - first_pick, end - first_end);
    if (!flipped.valid) {
        return invalid(pair + " cannot be flipped alone: in the way stand " +
                       named(flipped.in_the_way, first_pick, first_end));
    }
    std::vector<Stack> stacks = block.stacks();
    std::vector<std::uint32_t> cells(block.cells().begin(), block.cells().end());
    const auto known = std::find(stacks.begin(), stacks.end(), flipped.stack);
    cells[row * block.columns() + column] = static_cast<std::uint32_t>(known - stacks.begin());
    if (known == stacks.end()) stacks.push_back(flipped.stack);
    return Block::make(block.t(), block.p(), std::move(stacks), std::move(cells), block.height());
}

}  // namespace weave
