#include <weave/block/flip.hpp>

#include <algorithm>
#include <optional>
#include <utility>

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

std::string pair_of(const Flip& wish) {
    return "pick " + std::to_string(wish.pick + 1) + " and end " + std::to_string(wish.end + 1);
}

std::string not_alone(const Flip& wish, const FlippedStack& flipped, std::size_t first_pick,
                      std::size_t first_end) {
    return pair_of(wish) + " cannot be flipped alone: in the way stand " +
           named(flipped.in_the_way, first_pick, first_end);
}

bool is_met(const BlockGrid& grid, const Stack& stack, const Flip& wish) {
    const std::size_t weft = wish.pick - grid.first_pick(grid.row_of_pick(wish.pick)),
                      warp = wish.end - grid.first_end(grid.column_of_end(wish.end));
    return stack.weft_over(weft, warp) == wish.weft_over;
}

/// Makes one flip in the stack of its cell, or says why not.
std::optional<std::string> refusal(const BlockGrid& grid, Stack& stack, const Flip& wish) {
    if (is_met(grid, stack, wish)) return {};
    const std::size_t first_pick = grid.first_pick(grid.row_of_pick(wish.pick));
    const std::size_t first_end = grid.first_end(grid.column_of_end(wish.end));
    const std::size_t weft = wish.pick - first_pick, warp = wish.end - first_end;
    FlippedStack flipped = flip(stack, weft, warp);
    if (!flipped.valid) return not_alone(wish, flipped, first_pick, first_end);
    stack = std::move(flipped.stack);
    return {};
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

Error no_crossing(const BlockGrid& grid, std::size_t pick, std::size_t end) {
    return bad_input("there is no crossing of " + pair_of({pick, end, false}) + ": the block has " +
                     std::to_string(grid.picks()) + " picks and " + std::to_string(grid.ends()) + " ends");
}

std::vector<RefusedFlip> flip_stacks(const BlockGrid& grid, std::span<const Flip> flips,
                                     std::map<std::size_t, Stack>& stacks) {
    std::vector<RefusedFlip> refused;
    // Of crossings with a flip that was made: how many refusals there were before the last such one.
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> settled;
    for (const Flip& wish : flips) {
        if (!grid.holds(wish.pick, wish.end)) {
            refused.push_back({wish, no_crossing(grid, wish.pick, wish.end).message});
            continue;
        }
        Stack& stack = stacks.at(grid.cell_of(wish.pick, wish.end));
        if (auto reason = refusal(grid, stack, wish)) {
            refused.push_back({wish, std::move(*reason)});
        } else if (!refused.empty()) {
            settled[{wish.pick, wish.end}] = refused.size();
        }
    }
    std::vector<RefusedFlip> lost;
    for (std::size_t k = 0; k < refused.size(); ++k) {
        const Flip& wish = refused[k].flip;
        const auto later = settled.find({wish.pick, wish.end});
        if (later != settled.end() && k < later->second) continue;
        const bool is_there = grid.holds(wish.pick, wish.end);
        if (is_there && is_met(grid, stacks.at(grid.cell_of(wish.pick, wish.end)), wish)) continue;
        lost.push_back(std::move(refused[k]));
    }
    return lost;
}

FlippedBlock apply_flips(Block block, std::span<const Flip> flips) {
    std::map<std::size_t, Stack> stacks;
    for (const Flip& wish : flips) {
        if (!block.grid().holds(wish.pick, wish.end)) continue;
        const std::size_t cell = block.grid().cell_of(wish.pick, wish.end);
        stacks.try_emplace(cell, block.stacks()[block.cells()[cell]]);
    }
    std::vector<RefusedFlip> refused = flip_stacks(block.grid(), flips, stacks);
    return {std::move(block).with_stacks(stacks), std::move(refused)};
}

PlacedStack stack_at(const Block& block, std::size_t pick, std::size_t end) {
    const std::size_t row = block.row_of_pick(pick), column = block.column_of_end(end);
    return {block.stack(row, column), block.first_pick(row), block.first_end(column)};
}

Result<Stack> flip(const PlacedStack& at, std::size_t pick, std::size_t end) {
    FlippedStack flipped = flip(at.stack, pick - at.first_pick, end - at.first_end);
    if (flipped.valid) return std::move(flipped.stack);
    return invalid(not_alone({pick, end, false}, flipped, at.first_pick, at.first_end));
}

Result<Block> flip(const Block& block, std::size_t pick, std::size_t end) {
    if (!block.grid().holds(pick, end)) return no_crossing(block.grid(), pick, end);
    WEAVE_TRY(Stack flipped, flip(stack_at(block, pick, end), pick, end));
    return Block(block).with_stacks({{block.grid().cell_of(pick, end), std::move(flipped)}});
}

}  // namespace weave
