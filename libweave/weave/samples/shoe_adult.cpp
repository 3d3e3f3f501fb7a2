#include <weave/samples/build.hpp>
#include <weave/samples/makers.hpp>
#include <weave/samples/shoe_map.hpp>

#include <array>
#include <map>

namespace weave::sample {

namespace {

// A cell of the adult shoe has six wefts, from the bottom up 0, 1 sole, 2, 3 insole, 4, 5 upper, and six ends
// in the same order. All blocks are 8 x 8 cells, 48 ends x 48 picks, so they merge in any stencil.
//
// Two ends and two wefts of a layer share a cell, and a plain weave of them would need each to lie over and
// under the other: the upper's weaves are those that a stack can hold, and ribs and baskets stand where one
// would think of plain weave.

constexpr std::size_t block_size = 8, wefts = 6;
constexpr Below upper_wefts = 0b110000U;

constexpr std::array<std::size_t, 4> zigzag{0, 1, 2, 1};

/// The two ends of the sole go from under both sole wefts (the tread) to over both and back, half a zigzag
/// apart, or, as lugs, side by side. Columns differ by an odd number of steps, so every sole weft binds in
/// every row.
void lay_sole(Sole sole, std::size_t i, std::size_t j, std::array<End, 6>& ends) {
    static constexpr std::array<std::size_t, 8> chevron{0, 1, 2, 3, 4, 3, 2, 1};
    const std::size_t step = sole == Sole::zigzag_left ? i + 3 * j
                             : sole == Sole::chevron   ? i + chevron[j % 8]
                                                       : i + j;
    const std::size_t apart = sole == Sole::lugs ? 0 : 2;
    ends[0] = sole == Sole::trimmed ? loose_at(0) : at(zigzag[step % 4]);
    ends[1] = sole == Sole::trimmed ? loose_at(0) : at(zigzag[(step + apart) % 4]);
}

/// End 2 ties the insole to the sole by going under the sole's upper weft, end 3 binds the insole's own
/// wefts. Firm: in every row; soft: every other; loft: with long slack stretches between; air: end 2 does not
/// reach the sole.
void lay_insole(const Recipe& recipe, std::size_t i, std::size_t j, std::array<End, 6>& ends) {
    if (recipe.sole == Sole::trimmed) {
        // The side of the shoe: the insole's ends bind the wefts of sole and insole in one thin layer.
        const bool even = (i + j) % 2 == 0;
        ends[2] = at(even ? 3 : 0);
        ends[3] = at(even ? 1 : 4);
        return;
    }
    using Wave = std::array<std::size_t, 8>;
    static constexpr std::array<std::array<Wave, 2>, 4> waves{{
        {Wave{3, 1, 3, 1, 3, 1, 3, 1}, Wave{2, 4, 2, 4, 2, 4, 2, 4}},
        {Wave{1, 2, 3, 2, 1, 2, 3, 2}, Wave{4, 3, 2, 3, 4, 3, 2, 3}},
        {Wave{1, 2, 2, 3, 3, 3, 2, 2}, Wave{4, 4, 3, 3, 2, 2, 3, 3}},
        {Wave{3, 2, 3, 2, 3, 2, 3, 2}, Wave{3, 3, 4, 4, 3, 3, 4, 4}},
    }};
    const auto& [lower, upper] = waves[static_cast<std::size_t>(recipe.insole)];
    ends[2] = at(lower[(i + 3 * j) % 8]);
    ends[3] = at(upper[(i + 3 * j) % 8]);
}

/// Whether an end of the upper lies over a weft of the upper; both counted through the block, two a cell.
bool upper_lifts(Upper upper, std::size_t pick, std::size_t end) {
    const std::size_t row = pick / 2, column = end / 2;
    const auto twill = [](std::size_t x, std::size_t y) { return (y + 16 - x) % 4 < 2; };
    const auto folded = [](std::size_t x) { return x % 16 < 8 ? x % 16 : 15 - x % 16; };
    static constexpr std::array<std::size_t, 4> broken{0, 2, 3, 1};
    switch (upper) {
        case Upper::twill_right:
            return twill(pick, end);
        case Upper::twill_left:
            return twill(pick, 15 - end);
        case Upper::herringbone:
            return end % 8 < 4 ? twill(pick, end) : twill(pick, 15 - end);
        case Upper::diamond:
            return twill(folded(pick), folded(end));
        case Upper::basket:
            return (row + column) % 2 == 0;
        case Upper::warp_rib:
            return (row + end) % 2 == 0;
        case Upper::weft_rib:
            return (pick + column) % 2 == 0;
        case Upper::warp_face:
            return end % 4 != broken[pick % 4];
        case Upper::weft_face:
            return end % 4 == broken[pick % 4];
        case Upper::crepe:
            return (row + column) % 2 == 0 ? (row / 2 + end) % 2 == 0 : (pick + column / 2) % 2 == 0;
        case Upper::opening:
            return true;
    }
    return true;
}

void lay_upper(Upper upper, std::size_t i, std::size_t j, std::array<End, 6>& ends) {
    for (std::size_t end = 0; end < 2; ++end) {
        Below below = lowest(4);
        for (std::size_t weft = 0; weft < 2; ++weft) {
            if (upper_lifts(upper, 2 * i + weft, 2 * j + end)) below |= Below{1} << (4 + weft);
        }
        ends[4 + end] = {below, upper == Upper::opening};
    }
}

/// At its points an end of the upper dives under the insole's upper weft where it is down anyway; at a welt
/// an end of the sole rises over the insole's lower weft as well.
void join(Join join, std::size_t i, std::size_t j, std::array<End, 6>& ends) {
    const std::size_t apart = join == Join::sparse ? 8 : join == Join::none ? 0 : 4;
    if (apart == 0 || (i + 3 * j) % apart > 1) return;
    for (std::size_t end = 4; end < 6; ++end) {
        if ((ends[end].below & upper_wefts) != upper_wefts) {
            // Of the wefts that it lies over it keeps the sole's and the insole's lower one, and dives under
            // the rest.
            ends[end].below = lowest(3);
            break;
        }
    }
    if (join == Join::welt) ends[i % 2].below = lowest(3);
}

/// Insole and upper woven into one flat cloth, with the sole's ends loose below it to be trimmed away.
void lay_flat(bool twill, std::size_t i, std::size_t j, std::array<End, 6>& ends) {
    static constexpr std::array<std::array<std::size_t, 4>, 2> rib{{{4, 1, 6, 3}, {0, 4, 2, 5}}};
    static constexpr std::array<std::array<std::size_t, 4>, 4> slant{
        {{4, 1, 6, 3}, {4, 0, 5, 2}, {1, 4, 3, 6}, {0, 4, 2, 5}}};
    const auto& heights = twill ? slant[(i + j) % 4] : rib[(i + j) % 2];
    for (std::size_t end = 0; end < 4; ++end) ends[2 + end] = at(heights[end]);
}

Stack stack_of(const Recipe& recipe, std::size_t i, std::size_t j) {
    std::array<End, 6> ends;
    lay_sole(recipe.sole, i, j, ends);
    if (recipe.join == Join::flat_rib || recipe.join == Join::flat_twill) {
        lay_flat(recipe.join == Join::flat_twill, i, j, ends);
        return cell(wefts, ends);
    }
    lay_insole(recipe, i, j, ends);
    lay_upper(recipe.upper, i, j, ends);
    join(recipe.join, i, j, ends);
    return cell(wefts, ends, recipe.upper == Upper::opening ? upper_wefts : 0);
}

std::string name_of(const Recipe& recipe, std::size_t number) {
    static constexpr std::array sole{"trimmed", "zigzag-right", "zigzag-left", "chevron", "lugs"};
    static constexpr std::array insole{"firm", "soft", "loft", "air"};
    static constexpr std::array upper{"twill-right", "twill-left", "herringbone", "diamond",
                                      "basket",      "warp-rib",   "weft-rib",    "warp-face",
                                      "weft-face",   "crepe",      "opening"};
    static constexpr std::array joined{"", ".sparse", ".dense", ".welt"};
    const std::string prefix = (number < 10 ? "B0" : "B") + std::to_string(number) + ".";
    if (recipe.join == Join::flat_rib) return prefix + "trim.flat-rib";
    if (recipe.join == Join::flat_twill) return prefix + "rim.flat-twill";
    const auto word = [](const auto& words, auto value) {
        return std::string(words[static_cast<std::size_t>(value)]);
    };
    const std::string lower = recipe.sole == Sole::trimmed
                                  ? std::string("side")
                                  : word(sole, recipe.sole) + "." + word(insole, recipe.insole);
    return prefix + lower + "." + word(upper, recipe.upper) + word(joined, recipe.join);
}

void plan_yarns(Design& design) {
    design.warp.yarns = {yarn("PVC-coated polyester", "#2c3e70", 0.14, 110, 700, 0.06),
                         cotton("insole cotton", "#b0413f"), cotton("upper cotton", "#e08a2c", 0.1, 20)};
    design.warp.order.once = {0, 0, 1, 1, 2, 2};
    design.warp.beams = {{"sole"}, {"insole"}, {"upper"}};
    design.warp.beam_order.once = {0, 0, 1, 1, 2, 2};
    design.warp.density_ends_per_cm = 133;
    design.warp.ends_per_dent = 6;
    design.weft.yarns = {yarn("sole polyester", "#59616b", 0.12, 60, 400, 0.03),
                         cotton("insole cotton", "#b9a58a", 0.1, 25),
                         cotton("upper cotton", "#efe6d2", 0.08, 15)};
    design.weft.feeders = {{"sole", 0}, {"insole", 1}, {"upper", 2}};
    design.weft.feeder_order = {{0}, {0}, {1}, {1}, {2}, {2}};
    design.weft.density_picks_per_cm = 30;
}

}  // namespace

Design shoe_adult() {
    Design design;
    design.title = "Shoe 42";  // eight characters are all that the loom's file has room for
    design.notes =
        "A full-size right shoe, woven flat and seen from above: heel first, toe last. Three sets of ends "
        "and three shuttles make a zigzag sole of coated polyester, a cotton insole with more and less "
        "cushion, and an upper with toe cap, vents, lace stays with eyelets, tongue with lace loops, "
        "stripes, seams, collar and heel counter. Along the rim all is one cloth, which closes the shoe; "
        "outside the sole its ends bind nothing and are trimmed, as are the upper's over the ankle opening "
        "and in the eyelets.";
    plan_yarns(design);
    StencilMap map{shoe_rows, shoe_columns, {}};
    map.blocks.reserve(shoe_rows * shoe_columns);
    std::map<Recipe, std::uint16_t> numbers;
    std::vector<std::string> names;
    const std::pair<const Recipe, std::uint16_t>* before = nullptr;  // neighbours are mostly alike
    for (const Recipe& recipe : shoe_recipes()) {
        if (before == nullptr || before->first != recipe) {
            const auto [known, fresh] = numbers.try_emplace(recipe, static_cast<std::uint16_t>(names.size()));
            before = &*known;
            if (fresh) {
                names.push_back(name_of(recipe, names.size() + 1));
                add(design, names.back(),
                    stacks(block_size, block_size, wefts, 6,
                           [&](std::size_t i, std::size_t j) { return stack_of(recipe, i, j); }));
            }
        }
        map.blocks.push_back(before->second);
    }
    add(design, "shoe", stencilled(names, std::move(map)));
    design.scene.weft_mode = WeftMode::wraparound;
    design.scene.boundary_y = Boundary::free;
    return design;
}

}  // namespace weave::sample
