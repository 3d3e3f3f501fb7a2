#include <weave/samples/build.hpp>
#include <weave/samples/makers.hpp>

#include <array>
#include <cmath>

namespace weave::sample {

namespace {

/// The half width, in columns, of a shoe's outline where it is rounded off: at `along` of `length` rows from
/// the tip.
double rounded(double along, double length, double full, double power) {
    const double rest = 1 - std::min(1.0, along / length);
    return full * std::pow(1 - std::pow(rest, power), 1 / power);
}

/// Block `inside` where a column's middle lies within `half_width(row)` of the middle, `outside` elsewhere.
template <class BlockOfCell>
StencilMap draw(std::size_t rows, std::size_t columns, BlockOfCell block_of_cell) {
    StencilMap map{rows, columns, {}};
    for (std::size_t i = 0; i < rows; ++i) {
        for (std::size_t j = 0; j < columns; ++j) {
            const double across = std::abs(static_cast<double>(j) + 0.5 - static_cast<double>(columns) / 2);
            map.blocks.push_back(block_of_cell(static_cast<double>(i) + 0.5, across, 2 * j < columns));
        }
    }
    return map;
}

/// A plain-weave layer of one end and two wefts: in every other column the first weft lies over the end, else
/// the second.
Below plain_pair(std::size_t first, std::size_t second, std::size_t column) {
    return Below{1} << (column % 2 == 0 ? second : first);
}

// The baby shoe. End 0 of a column is the sole's, end 1 the top's. Toe and heel have four wefts a row that
// the shuttle inserts in the order sole, top, sole, top, so each turn ties the layers together at a side. The
// middle has six: sole, right top there and back, sole, left top there and back.

constexpr std::size_t baby_columns = 40;

Stack baby_shoe(std::size_t, std::size_t j) {
    const Below sole = plain_pair(0, 2, j), top = plain_pair(1, 3, j);
    return cell(4, {End{sole}, End{0b0101U | top}});
}

/// Outside the shoe the wefts lie loose between the loose ends: the turns pull them in to the edge.
Stack baby_outside(std::size_t wefts) {
    return cell(wefts, {loose_at(0), loose_at(wefts)}, lowest(wefts));
}

/// At the tips both layers are woven as one: both ends bind all four wefts, and no two wefts share a shed, or
/// the turn between them would pull out.
Stack baby_seam(std::size_t, std::size_t j) {
    if (j % 2 == 0) return cell(4, {End{0b0011U}, End{0b0111U}});
    return cell(4, {End{0b1000U}, End{0b1010U}});
}

/// The middle where the top end weaves with wefts `first` and `second`; the other half's top wefts lie idle
/// inside the shoe.
Stack baby_middle(std::size_t j, std::size_t first, std::size_t second) {
    const Below sole = plain_pair(0, 3, j), top = plain_pair(first, second, j);
    const Below own = Below{1} << first | Below{1} << second;
    const Below idle = 0b110110U & ~own;
    return cell(6, {End{sole}, End{0b001001U | idle | top}}, idle);
}

/// In the ankle hole only the sole is woven; the top end is cut away.
Stack baby_hole(std::size_t, std::size_t j) {
    return cell(6, {End{plain_pair(0, 3, j)}, loose_at(6)}, 0b110110U);
}

/// A tip of the baby shoe, toe or heel: its rounded end comes first, or last.
StencilMap baby_tip(std::size_t rows, double rounding, bool tip_first) {
    const auto length = static_cast<double>(rows);
    return draw(rows, baby_columns, [=](double row, double across, bool) -> std::uint16_t {
        const double along = tip_first ? row : length - row;
        const double half = std::max(5.0, rounded(along, rounding, 18, 2.2));
        if (across >= half) return 1;
        return along < 3 || (along < 7 && across > half - 2) ? 2 : 0;
    });
}

StencilMap baby_middle_map(std::size_t rows) {
    return draw(rows, baby_columns, [=](double row, double across, bool left) -> std::uint16_t {
        const double middle = static_cast<double>(rows) / 2, along = (row - middle) / (middle - 0.5);
        const double hole = 10 * std::sqrt(std::max(0.0, 1 - along * along));
        if (across >= 18 - 1.5 * (1 - along * along)) return 3;
        return across < hole ? 1 : left ? 0 : 2;
    });
}

void plan_shoe(Design& design) {
    design.scene.weft_mode = WeftMode::wraparound;
    design.scene.boundary_x = Boundary::periodic;
    design.scene.boundary_y = Boundary::free;
}

}  // namespace

Design shoe_baby() {
    Design design = cloth("Baby shoe",
                          "Two plain-weave layers, a top and a sole, from seven blocks and three stencils. "
                          "One shuttle closes the sides by its turns, and in the middle weaves the left and "
                          "the right top layer apart, so that a hole for the ankle stays open once the "
                          "loose ends are trimmed. The paper counts six blocks but names seven, A to G; "
                          "here there are the seven that it names.",
                          cotton("top warp", "#e08a2c", 0.2, 80), cotton("weft", "#8f959b", 0.2, 80));
    design.warp.yarns.push_back(cotton("sole warp", "#3f6fb0", 0.2, 80));
    design.warp.order.once = {1, 0};
    design.warp.beams = {{"sole"}, {"top"}};
    design.warp.beam_order.once = {0, 1};
    design.warp.density_ends_per_cm = 40;
    design.warp.ends_per_dent = 4;
    design.weft.density_picks_per_cm = 8;
    add(design, "A", stacks(1, 2, 4, 2, baby_shoe));
    add(design, "B", stacks(1, 1, 4, 2, [](std::size_t, std::size_t) { return baby_outside(4); }));
    add(design, "C", stacks(1, 2, 4, 2, baby_seam));
    add(design, "D", stacks(1, 2, 6, 2, [](std::size_t, std::size_t j) { return baby_middle(j, 4, 5); }));
    add(design, "E", stacks(1, 2, 6, 2, baby_hole));
    add(design, "F", stacks(1, 2, 6, 2, [](std::size_t, std::size_t j) { return baby_middle(j, 1, 2); }));
    add(design, "G", stacks(1, 1, 6, 2, [](std::size_t, std::size_t) { return baby_outside(6); }));
    add(design, "heel", stencilled({"A", "B", "C"}, baby_tip(18, 12, true)));
    add(design, "middle", stencilled({"D", "E", "F", "G"}, baby_middle_map(24)));
    add(design, "toe", stencilled({"A", "B", "C"}, baby_tip(34, 22, false)));
    add(design, "back", attached("heel", "middle", Face::plus_x));
    add(design, "shoe", attached("back", "toe", Face::plus_x));
    plan_shoe(design);
    return design;
}

namespace {

// The toddler shoe. Ends of a column: 0 sole (zigzag), 1 and 2 insole (layer to layer), 3 top. Wefts are
// first numbered from the bottom up: 0, 1 sole, 2, 3 insole, 4, 5 top; in the middle 4, 5 left top and 6, 7
// right top. Then each block is renumbered to the order of insertion.

constexpr std::size_t toddler_columns = 48;
constexpr std::array<std::size_t, 4> zigzag{0, 1, 2, 1};

End toddler_sole(std::size_t i, std::size_t j) {
    return at(zigzag[(i + j) % 4]);
}

/// End 1 binds the sole's upper and the insole's lower weft, end 2 both wefts of the insole.
End toddler_insole(std::size_t i, std::size_t j, std::size_t end) {
    return at(2 + (end - 1) - 1 + zigzag[(i + j + 2 * end) % 4]);
}

/// The top end among wefts `first` and `second`, over the four of the sole and `more`.
End toddler_top(std::size_t j, std::size_t first, std::size_t second, Below more = 0) {
    return {lowest(4) | more | plain_pair(first, second, j), false};
}

/// The thin lower layer of the edges: its three ends bind all four lower wefts in one flat cloth.
std::array<End, 3> toddler_thin(std::size_t i, std::size_t j) {
    const bool up = (i + j) % 2 == 0;
    return {at(up ? 4 : 0), at(up ? 1 : 3), at(up ? 0 : 4)};
}

Stack toddler_full(std::size_t i, std::size_t j) {
    return cell(6,
                {toddler_sole(i, j), toddler_insole(i, j, 1), toddler_insole(i, j, 2), toddler_top(j, 4, 5)});
}

Stack toddler_edge(std::size_t i, std::size_t j) {
    const auto thin = toddler_thin(i, j);
    return cell(6, {thin[0], thin[1], thin[2], toddler_top(j, 4, 5)});
}

/// The tips: top and lower layer woven as one, which closes the shoe at toe and heel.
Stack toddler_seam(std::size_t i, std::size_t j) {
    const bool up = (i + j) % 2 == 0;
    return cell(6, {at(up ? 3 : 0), at(up ? 1 : 5), at(up ? 6 : 2), at(up ? 3 : 6)});
}

Stack toddler_middle(std::size_t i, std::size_t j, bool left, bool thin_edge) {
    const std::size_t first = left ? 4 : 6;
    const Below idle = 0xf0U & ~(3U << first);
    const End top = toddler_top(j, first, first + 1, idle);
    const auto thin = toddler_thin(i, j);
    if (thin_edge) return cell(8, {thin[0], thin[1], thin[2], top}, idle);
    return cell(8, {toddler_sole(i, j), toddler_insole(i, j, 1), toddler_insole(i, j, 2), top}, idle);
}

Stack toddler_hole(std::size_t i, std::size_t j) {
    return cell(8, {toddler_sole(i, j), toddler_insole(i, j, 1), toddler_insole(i, j, 2), loose_at(8)},
                0xf0U);
}

Stack toddler_outside(std::size_t, std::size_t) {
    return cell(6, {loose_at(0), loose_at(0), loose_at(0), loose_at(6)}, lowest(6));
}

/// A leaf whose wefts are numbered from the bottom up, and the same with each row in the order of insertion.
template <class StackOfCell>
void add_renumbered(Design& design, const std::string& name, std::uint32_t wefts, StackOfCell stack_of_cell,
                    const std::vector<std::size_t>& order) {
    add(design, name + "-drawn", stacks(4, 4, wefts, 4, stack_of_cell));
    std::string before = name + "-drawn";
    for (std::size_t row = 0; row < 4; ++row) {
        const std::string after = row == 3 ? name : name + "-" + std::to_string(row + 1);
        add(design, after, renumbered(before, row, order));
        before = after;
    }
}

/// Toe or heel: A full, B thin edge, C outside, D seam.
StencilMap toddler_tip(std::size_t rows, double rounding, bool tip_first) {
    const auto length = static_cast<double>(rows);
    return draw(rows, toddler_columns, [=](double row, double across, bool) -> std::uint16_t {
        const double along = tip_first ? row : length - row;
        const double half = std::max(7.0, rounded(along, rounding, 24, 2.2));
        if (across >= half) return 2;
        if (along < 4) return 3;
        const double sole = rounded(along - 4, rounding, 18, 2.2);
        return across < sole ? 0 : 1;
    });
}

/// The middle: E left, F hole, I right, and the thin edges G and H out to the sides of the cloth.
StencilMap toddler_middle_map(std::size_t rows) {
    return draw(rows, toddler_columns, [=](double row, double across, bool left) -> std::uint16_t {
        const double middle = static_cast<double>(rows) / 2, along = (row - middle) / (middle - 0.5);
        const double round = std::max(0.0, 1 - along * along);
        if (across < 11 * std::sqrt(round)) return 1;
        const bool edge = across >= 18 - 2 * round;
        return left ? (edge ? 2 : 0) : (edge ? 3 : 4);
    });
}

}  // namespace

Design shoe_toddler() {
    Design design = cloth(
        "Toddler shoe",
        "Three layers of ends: a zigzag sole for grip, a thick layer-to-layer insole tied to it, and a "
        "thin top. Nine blocks A to I and three stencils; B, G and H are the thin edges that unfold to "
        "the sides of the shoe. The wefts are renumbered so that one shuttle closes the sides and leaves the "
        "ankle hole open.",
        cotton("top warp", "#e08a2c", 0.12, 30), cotton("weft", "#8f959b", 0.15, 50));
    design.warp.yarns.push_back(cotton("insole warp", "#b0413f", 0.18, 70));
    design.warp.yarns.push_back(yarn("sole warp, coated polyester", "#2c3e70", 0.2, 110, 600, 0.08));
    design.warp.order.once = {2, 1, 1, 0};
    design.warp.beams = {{"sole"}, {"insole"}, {"top"}};
    design.warp.beam_order.once = {0, 1, 1, 2};
    design.warp.density_ends_per_cm = 60;
    design.warp.ends_per_dent = 4;
    design.weft.density_picks_per_cm = 8;

    const std::vector<std::size_t> tip{0, 4, 2, 5, 1, 3}, middle{0, 6, 7, 1, 4, 5, 2, 3};
    const auto in_middle = [](bool left, bool edge) {
        return [=](std::size_t i, std::size_t j) { return toddler_middle(i, j, left, edge); };
    };
    add_renumbered(design, "A", 6, toddler_full, tip);
    add_renumbered(design, "B", 6, toddler_edge, tip);
    add_renumbered(design, "C", 6, toddler_outside, tip);
    add_renumbered(design, "D", 6, toddler_seam, tip);
    add_renumbered(design, "E", 8, in_middle(true, false), middle);
    add_renumbered(design, "F", 8, toddler_hole, middle);
    add_renumbered(design, "G", 8, in_middle(true, true), middle);
    add_renumbered(design, "H", 8, in_middle(false, true), middle);
    add_renumbered(design, "I", 8, in_middle(false, false), middle);
    add(design, "heel", stencilled({"A", "B", "C", "D"}, toddler_tip(24, 16, true)));
    add(design, "middle", stencilled({"E", "F", "G", "H", "I"}, toddler_middle_map(28)));
    add(design, "toe", stencilled({"A", "B", "C", "D"}, toddler_tip(40, 28, false)));
    add(design, "back", attached("heel", "middle", Face::plus_x));
    add(design, "shoe", attached("back", "toe", Face::plus_x));
    plan_shoe(design);
    return design;
}

}  // namespace weave::sample
