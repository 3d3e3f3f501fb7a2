#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace weave::sample {

/// What a region of the adult shoe is made of. The sole's ends are at the bottom, the insole's above, the
/// upper's on top.
enum class Sole : std::uint8_t { trimmed, zigzag_right, zigzag_left, chevron, lugs };
enum class Insole : std::uint8_t { firm, soft, loft, air };
enum class Upper : std::uint8_t {
    twill_right,
    twill_left,
    herringbone,
    diamond,
    basket,
    warp_rib,
    weft_rib,
    warp_face,
    weft_face,
    crepe,
    opening
};
/// How the upper holds to what is below it: not at all, by a few points, by many, or, with the sole, by a
/// welt; or all that is not trimmed is one flat cloth, in one of two weaves.
enum class Join : std::uint8_t { none, sparse, dense, welt, flat_rib, flat_twill };

struct Recipe {
    Sole sole = Sole::trimmed;
    Insole insole = Insole::firm;
    Upper upper = Upper::basket;
    Join join = Join::flat_rib;
    friend auto operator<=>(const Recipe&, const Recipe&) = default;
};

/// The adult shoe seen from above, heel first: one recipe a cell, row by row. 1,000 rows of 400 columns.
inline constexpr std::size_t shoe_rows = 1000, shoe_columns = 400;
std::vector<Recipe> shoe_recipes();

}  // namespace weave::sample
