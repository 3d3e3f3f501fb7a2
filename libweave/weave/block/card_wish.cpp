#include <weave/block/card_wish.hpp>

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

namespace weave {

namespace {

struct WishedCrossing {
    std::size_t cell = 0;
    Flip flip;
};

std::pair<std::size_t, std::size_t> place(const Flip& flip) {
    return {flip.pick, flip.end};
}

/// What a wish asks for, cell by cell.
std::vector<WishedCrossing> by_cell(const BlockGrid& grid, const CardWish& wish) {
    std::vector<WishedCrossing> crossings;
    crossings.reserve(wish.pixels.picks() * wish.pixels.ends());
    for (std::size_t k = 0; k < wish.pixels.picks(); ++k) {
        for (std::size_t j = 0; j < wish.pixels.ends(); ++j) {
            const std::size_t pick = (wish.pick + k) % grid.picks(), end = (wish.end + j) % grid.ends();
            crossings.push_back({grid.cell_of(pick, end), {pick, end, wish.pixels.weft_over(k, j)}});
        }
    }
    std::ranges::sort(crossings, {}, [](const WishedCrossing& one) {
        return std::tuple(one.cell, one.flip.pick, one.flip.end);
    });
    return crossings;
}

/// Makes the flips of one stack that can be made, until none can, and gives those that are left.
std::vector<Flip> settle(PlacedStack at, std::span<const WishedCrossing> wished, std::vector<Flip>& made) {
    std::vector<Flip> open;
    for (const WishedCrossing& one : wished) {
        const bool weft_over = at.stack.weft_over(one.flip.pick - at.first_pick, one.flip.end - at.first_end);
        if (weft_over != one.flip.weft_over) open.push_back(one.flip);
    }
    for (bool has_changed = true; has_changed;) {
        std::vector<Flip> refused;
        for (const Flip& wish : open) {
            FlippedStack flipped = flip(at.stack, wish.pick - at.first_pick, wish.end - at.first_end);
            (flipped.valid ? made : refused).push_back(wish);
            if (flipped.valid) at.stack = std::move(flipped.stack);
        }
        has_changed = refused.size() < open.size();
        open = std::move(refused);
    }
    return open;
}

/// Why a crossing cannot be flipped after those flips that are of its stack.
std::string reason_of(const Block& block, const Flip& refused, std::span<const Flip> made) {
    PlacedStack at = stack_at(block, refused.pick, refused.end);
    const std::size_t cell = block.grid().cell_of(refused.pick, refused.end);
    for (const Flip& one : made) {
        if (block.grid().cell_of(one.pick, one.end) == cell)
            at.stack = flip(at.stack, one.pick - at.first_pick, one.end - at.first_end).stack;
    }
    return flip(at, refused.pick, refused.end).error().message;
}

}  // namespace

GrantedWish grant(const Block& block, const CardWish& wish) {
    GrantedWish granted;
    const std::vector<WishedCrossing> crossings = by_cell(block.grid(), wish);
    for (auto from = crossings.begin(); from != crossings.end();) {
        const auto to = std::find_if(from, crossings.end(),
                                     [&](const WishedCrossing& one) { return one.cell != from->cell; });
        const std::vector<Flip> left =
            settle(stack_at(block, from->flip.pick, from->flip.end), {from, to}, granted.flips);
        granted.refused.insert(granted.refused.end(), left.begin(), left.end());
        from = to;
    }
    std::ranges::sort(granted.refused, {}, place);
    if (!granted.refused.empty()) granted.reason = reason_of(block, granted.refused.front(), granted.flips);
    return granted;
}

}  // namespace weave
