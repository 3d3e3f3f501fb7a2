#include <weave/block/card_part.hpp>

namespace weave {

namespace {

/// A part whose pixels `weft_over(pick, end)` tells.
template <class WeftOver>
CardImage part_from(std::size_t picks, std::size_t ends, WeftOver weft_over) {
    CardImage part(picks, ends);
    for (std::size_t pick = 0; pick < picks; ++pick) {
        for (std::size_t end = 0; end < ends; ++end) part.set(pick, end, weft_over(pick, end));
    }
    return part;
}

}  // namespace

CardImage part_of(const CardImage& card, std::size_t pick, std::size_t end, std::size_t picks,
                  std::size_t ends) {
    return part_from(picks, ends, [&](std::size_t k, std::size_t j) {
        return card.weft_over((pick + k) % card.picks(), (end + j) % card.ends());
    });
}

CardImage one_sided(std::size_t picks, std::size_t ends, bool weft_over) {
    return part_from(picks, ends, [&](std::size_t, std::size_t) { return weft_over; });
}

CardImage inverted(const CardImage& part) {
    return part_from(part.picks(), part.ends(),
                     [&](std::size_t pick, std::size_t end) { return !part.weft_over(pick, end); });
}

CardImage mirrored_across(const CardImage& part) {
    return part_from(part.picks(), part.ends(), [&](std::size_t pick, std::size_t end) {
        return part.weft_over(pick, part.ends() - 1 - end);
    });
}

CardImage mirrored_along(const CardImage& part) {
    return part_from(part.picks(), part.ends(), [&](std::size_t pick, std::size_t end) {
        return part.weft_over(part.picks() - 1 - pick, end);
    });
}

}  // namespace weave
