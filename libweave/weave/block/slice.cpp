#include <weave/block/slice.hpp>

#include <weave/core/text.hpp>

#include <algorithm>

namespace weave {

namespace {

std::string place_of(std::size_t position) {
    return "positions[" + std::to_string(position) + "]";
}

/// One position as it is drawn, disabled wefts among the others.
Result<Stack> drawn_stack(const std::vector<SliceYarn>& places) {
    std::vector<Slot> slots;
    slots.reserve(places.size());
    for (const SliceYarn& place : places) {
        if (place.disabled && place.yarn.is_warp())
            return bad_input(
                "disables an end, which runs through the whole cloth; only wefts can be disabled");
        slots.push_back(place.yarn);
    }
    Stack stack(std::move(slots));
    WEAVE_CHECK_OK(stack.check());
    return stack;
}

/// Marks the wefts that a position disables, by their numbers in the drawing.
void mark_disabled(const std::vector<SliceYarn>& places, std::vector<bool>& disabled) {
    for (const SliceYarn& place : places) {
        if (place.disabled && place.yarn.is_weft()) disabled[place.yarn.index()] = true;
    }
}

/// The stack without its disabled wefts: their places stay, empty, and the numbers of the others close up.
Stack without(const Stack& drawn, const std::vector<bool>& disabled) {
    std::vector<std::size_t> closed_up(disabled.size());
    for (std::size_t weft = 1; weft < disabled.size(); ++weft)
        closed_up[weft] = closed_up[weft - 1] + (disabled[weft - 1] ? 0 : 1);
    std::vector<Slot> slots(drawn.slots().begin(), drawn.slots().end());
    for (Slot& slot : slots) {
        if (slot.is_weft()) slot = disabled[slot.index()] ? Slot() : slot.renumbered(closed_up[slot.index()]);
    }
    return Stack(std::move(slots));
}

/// The stacks of all positions as they are drawn, through which the same number of paths run.
Result<std::vector<Stack>> drawn_stacks(const Slice& slice) {
    const bool wefts_run = slice.dots == System::warp;
    const auto paths_of = [&](const Stack& stack) { return wefts_run ? stack.wefts() : stack.warps(); };
    std::vector<Stack> stacks;
    stacks.reserve(slice.positions.size());
    for (std::size_t position = 0; position < slice.positions.size(); ++position) {
        Result<Stack> stack = drawn_stack(slice.positions[position]);
        if (!stack) return std::move(stack).error().under(place_of(position));
        stacks.push_back(std::move(stack).value());
        if (paths_of(stacks.back()) != paths_of(stacks.front())) {
            return bad_input("has " + counted(paths_of(stacks.back()), wefts_run ? "pick" : "end") +
                                 " running along the slice, but " + place_of(0) + " has " +
                                 std::to_string(paths_of(stacks.front())),
                             place_of(position));
        }
    }
    return stacks;
}

std::vector<SliceYarn> drawn(const Stack& stack, std::size_t height) {
    std::vector<SliceYarn> places;
    for (const Slot slot : stack.slots()) places.push_back({slot, false});
    places.resize(height);
    return places;
}

}  // namespace

Result<Block> to_block(const Slice& slice) {
    if (slice.positions.empty()) return bad_input("a slice needs at least one position");
    const bool wefts_run = slice.dots == System::warp;
    WEAVE_TRY(const std::vector<Stack> stacks, drawn_stacks(slice));
    std::vector<bool> disabled(stacks.front().wefts());
    if (wefts_run) {  // one yarn all along: disabled anywhere, it is gone everywhere
        for (const auto& position : slice.positions) mark_disabled(position, disabled);
    }
    StackTable table;
    std::vector<std::uint32_t> t, p, cells;
    std::size_t height = 0;
    for (std::size_t position = 0; position < stacks.size(); ++position) {
        if (!wefts_run) {
            disabled.assign(stacks[position].wefts(), false);
            mark_disabled(slice.positions[position], disabled);
        }
        Stack stack = without(stacks[position], disabled);
        if (!wefts_run || t.empty()) t.push_back(static_cast<std::uint32_t>(stack.wefts()));
        if (wefts_run || p.empty()) p.push_back(static_cast<std::uint32_t>(stack.warps()));
        height = std::max(height, slice.positions[position].size());
        cells.push_back(table.number_of(std::move(stack)));
    }
    return Block::make(std::move(t), std::move(p), std::move(table).take(), std::move(cells), height);
}

Result<Slice> warp_slice(const Block& block, std::size_t column) {
    if (column >= block.columns()) {
        return invalid("there is no column " + std::to_string(column) + "; the last one is " +
                       std::to_string(block.columns() - 1));
    }
    Slice slice{System::weft, {}};
    for (std::size_t row = 0; row < block.rows(); ++row) {
        slice.positions.push_back(drawn(block.stack(row, column), block.height()));
    }
    return slice;
}

Result<Slice> weft_slice(const Block& block, std::size_t row) {
    if (row >= block.rows()) {
        return invalid("there is no row " + std::to_string(row) + "; the last one is " +
                       std::to_string(block.rows() - 1));
    }
    Slice slice{System::warp, {}};
    for (std::size_t column = 0; column < block.columns(); ++column) {
        slice.positions.push_back(drawn(block.stack(row, column), block.height()));
    }
    return slice;
}

Result<std::vector<SliceYarn>> parse_slice_position(std::string_view text) {
    std::vector<SliceYarn> places;
    for (std::size_t at = 0; (at = text.find_first_not_of(" \t", at)) != std::string_view::npos;) {
        std::string_view word = text.substr(at, text.find_first_of(" \t", at) - at);
        at += word.size();
        const bool disabled = word.size() > 2 && word.front() == '(' && word.back() == ')';
        if (disabled) word = word.substr(1, word.size() - 2);
        WEAVE_TRY(const Stack stack, parse_stack(word));
        const Slot yarn = stack.height() == 0 ? Slot() : stack.slots()[0];
        if (disabled && !yarn.is_weft())
            return bad_input("'(" + std::string(word.substr(0, 40)) +
                             ")' is no weft; only wefts can be disabled");
        places.push_back({yarn, disabled});
    }
    return places;
}

std::string to_text(const std::vector<SliceYarn>& position) {
    std::string text;
    for (const SliceYarn& place : position) {
        if (!text.empty()) text.push_back(' ');
        const std::string yarn = place.yarn.is_empty() ? "-" : to_text(Stack({place.yarn}));
        text += place.disabled && !place.yarn.is_empty() ? "(" + yarn + ")" : yarn;
    }
    return text;
}

}  // namespace weave
