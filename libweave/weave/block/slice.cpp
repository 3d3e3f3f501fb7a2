#include <weave/block/slice.hpp>

#include <algorithm>

namespace weave {

namespace {

bool is_dot(Slot yarn, System dots) {
    return dots == System::weft ? yarn.is_weft() : yarn.is_warp();
}

std::string place_of(std::size_t position) {
    return "positions[" + std::to_string(position) + "]";
}

/// The stack of one position with its disabled dots taken out and the numbers of the others closed up.
Result<Stack> stack_at(const std::vector<SliceYarn>& places, System dots) {
    std::vector<Slot> drawn;
    std::vector<bool> disabled;  // per dot, by its number in the drawing
    for (const SliceYarn& place : places) {
        drawn.push_back(place.yarn);
        if (is_dot(place.yarn, dots)) disabled.push_back(false);
        if (place.disabled && !place.yarn.is_empty() && !is_dot(place.yarn, dots)) {
            return bad_input(
                "disables a yarn that runs along the slice; only the yarns seen end-on can be disabled");
        }
    }
    WEAVE_CHECK_OK(Stack(drawn).check());
    for (const SliceYarn& place : places) {
        if (place.disabled && !place.yarn.is_empty()) disabled[place.yarn.index()] = true;
    }
    std::vector<std::size_t> closed_up(disabled.size());
    for (std::size_t dot = 1; dot < disabled.size(); ++dot) {
        closed_up[dot] = closed_up[dot - 1] + (disabled[dot - 1] ? 0 : 1);
    }
    for (Slot& slot : drawn) {
        if (is_dot(slot, dots))
            slot = disabled[slot.index()] ? Slot() : slot.renumbered(closed_up[slot.index()]);
    }
    return Stack(std::move(drawn));
}

std::string yarns_named(std::size_t count, bool wefts) {
    return std::to_string(count) + (wefts ? " weft" : " warp") + (count == 1 ? "" : "s");
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
    const auto paths_of = [&](const Stack& stack) { return wefts_run ? stack.wefts() : stack.warps(); };
    StackTable table;
    std::vector<std::uint32_t> dot_counts, cells;
    std::size_t paths = 0, height = 0;
    for (std::size_t position = 0; position < slice.positions.size(); ++position) {
        Result<Stack> stack = stack_at(slice.positions[position], slice.dots);
        if (!stack) return std::move(stack).error().under(place_of(position));
        if (position == 0) paths = paths_of(*stack);
        if (paths_of(*stack) != paths) {
            return bad_input("has " + yarns_named(paths_of(*stack), wefts_run) +
                                 " running along the slice, but " + place_of(0) + " has " +
                                 std::to_string(paths),
                             place_of(position));
        }
        dot_counts.push_back(static_cast<std::uint32_t>(wefts_run ? stack->warps() : stack->wefts()));
        height = std::max(height, slice.positions[position].size());
        cells.push_back(table.number_of(std::move(*stack)));
    }
    std::vector<std::uint32_t> path_counts{static_cast<std::uint32_t>(paths)};
    if (wefts_run) path_counts.swap(dot_counts);
    return Block::make(std::move(dot_counts), std::move(path_counts), std::move(table).take(),
                       std::move(cells), height);
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

Result<std::vector<SliceYarn>> parse_slice_position(std::string_view text, System dots) {
    std::vector<SliceYarn> places;
    for (std::size_t at = 0; (at = text.find_first_not_of(" \t", at)) != std::string_view::npos;) {
        std::string_view word = text.substr(at, text.find_first_of(" \t", at) - at);
        at += word.size();
        const bool disabled = word.size() > 2 && word.front() == '(' && word.back() == ')';
        if (disabled) word = word.substr(1, word.size() - 2);
        WEAVE_TRY(const Stack stack, parse_stack(word));
        const Slot yarn = stack.height() == 0 ? Slot() : stack.slots()[0];
        if (disabled && !is_dot(yarn, dots)) {
            return bad_input(
                "'(" + std::string(word.substr(0, 40)) + ")' disables what is not seen end-on in a " +
                (dots == System::weft ? "warp slice; only wefts" : "weft slice; only warps") + " can be");
        }
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
