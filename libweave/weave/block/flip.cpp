#include <weave/block/flip.hpp>

#include <algorithm>
#include <cstdint>
#include <map>
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

/// Whether the weft stands above the warp; both in the stack.
bool lies_over(const Stack& stack, std::size_t weft, std::size_t warp) {
    for (const Slot slot : stack.slots()) {
        if (slot.is_warp() && slot.index() == warp) return true;
        if (slot.is_weft() && slot.index() == weft) return false;
    }
    return false;
}

std::string pair_of(const Flip& wish) {
    return "pick " + std::to_string(wish.pick + 1) + " and end " + std::to_string(wish.end + 1);
}

std::string no_crossing(const Block& block, const Flip& wish) {
    return "there is no crossing of " + pair_of(wish) + ": the block has " + std::to_string(block.picks()) +
           " picks and " + std::to_string(block.ends()) + " ends";
}

bool is_inside(const Block& block, const Flip& wish) {
    return wish.pick < block.picks() && wish.end < block.ends();
}

std::size_t cell_of(const Block& block, const Flip& wish) {
    return block.row_of_pick(wish.pick) * block.columns() + block.column_of_end(wish.end);
}

/// The numbers of the flips cell by cell, those of one cell in their order, those outside the block last.
/// Flips of different cells do not touch each other, so they may be made in this order; and a stack that many
/// flips change then goes into the table once.
std::vector<std::size_t> by_cell(const Block& block, std::span<const Flip> flips) {
    std::vector<std::pair<std::size_t, std::size_t>> keyed;
    keyed.reserve(flips.size());
    for (std::size_t k = 0; k < flips.size(); ++k)
        keyed.emplace_back(is_inside(block, flips[k]) ? cell_of(block, flips[k]) : SIZE_MAX, k);
    std::sort(keyed.begin(), keyed.end());
    std::vector<std::size_t> order;
    order.reserve(keyed.size());
    for (const auto& [cell, k] : keyed) order.push_back(k);
    return order;
}

/// Makes one flip in the stack of its cell, or says why not.
std::optional<std::string> refusal(const Block& block, Stack& stack, const Flip& wish) {
    const std::size_t first_pick = block.first_pick(block.row_of_pick(wish.pick));
    const std::size_t first_end = block.first_end(block.column_of_end(wish.end));
    const std::size_t weft = wish.pick - first_pick, warp = wish.end - first_end;
    if (lies_over(stack, weft, warp) == wish.weft_over) return {};
    FlippedStack flipped = flip(stack, weft, warp);
    if (!flipped.valid) {
        return pair_of(wish) + " cannot be flipped alone: in the way stand " +
               named(flipped.in_the_way, first_pick, first_end);
    }
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

FlippedBlock apply_flips(const Block& block, std::span<const Flip> flips) {
    StackTable table;
    std::vector<std::uint32_t> moved;
    for (const Stack& stack : block.stacks()) moved.push_back(table.number_of(stack));
    std::vector<std::uint32_t> cells;
    cells.reserve(block.cells().size());
    for (const std::uint32_t cell : block.cells()) cells.push_back(moved[cell]);

    std::map<std::size_t, std::string> refusals;
    const std::vector<std::size_t> order = by_cell(block, flips);
    for (std::size_t k = 0; k < order.size();) {
        const Flip& first = flips[order[k]];
        if (!is_inside(block, first)) {
            refusals[order[k++]] = no_crossing(block, first);
            continue;
        }
        const std::size_t cell = cell_of(block, first);
        Stack stack = table.at(cells[cell]);
        for (;
             k < order.size() && is_inside(block, flips[order[k]]) && cell_of(block, flips[order[k]]) == cell;
             ++k) {
            if (auto reason = refusal(block, stack, flips[order[k]])) refusals[order[k]] = std::move(*reason);
        }
        cells[cell] = table.number_of(std::move(stack));
    }
    Result<Block> made =
        Block::make(block.t(), block.p(), std::move(table).take(), std::move(cells), block.height());
    assert(made);  // a flip only exchanges yarns within their stack
    FlippedBlock flipped{std::move(made).value(), {}};
    for (auto& [k, reason] : refusals) flipped.refused.push_back({flips[k], std::move(reason)});
    return flipped;
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
