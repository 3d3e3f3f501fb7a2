#include <weave/samples/build.hpp>
#include <weave/samples/makers.hpp>

#include <algorithm>
#include <array>

namespace weave::sample {

namespace {

/// Four layers, each with one weft a row and one end a column; wall k of the honeycomb joins layers k and k
/// + 1.
NodePtr tube_layers(std::size_t rows, const std::array<bool, 3>& joined) {
    return stacks(rows, 2, 4, 4, [&](std::size_t i, std::size_t j) {
        std::array<End, 4> ends;
        for (std::size_t layer = 0; layer < 4; ++layer) {
            const bool up = (i + j + layer) % 2 == 0;
            // Within its own layer an end lies over or under one weft, in a joined wall over or under two.
            const std::size_t low = layer > 0 && joined[layer - 1] ? layer - 1 : layer;
            const std::size_t high = layer < 3 && joined[layer] ? layer + 2 : layer + 1;
            ends[layer] = at(up ? high : low);
        }
        return cell(4, ends);
    });
}

}  // namespace

Design hexagon_tubes() {
    Design design = cloth(
        "Hexagon tubes",
        "Four layers that join in pairs and part again along the warp, so that the cells between them open "
        "to hexagons: first layers 1 and 2, and 3 and 4, are one wall each, then 2 and 3. The "
        "outermost wefts are pinned, which stands for whatever keeps the cloth from collapsing under "
        "warp tension. The paper shows its section; the weave was built from that description.",
        roving("glass warp", "#e08a2c", 0.15, 136),
        roving("glass weft", "#8f959b", 0.2, 200));
    design.warp.beams = {{"layer 1"}, {"layer 2"}, {"layer 3"}, {"layer 4"}};
    design.warp.beam_order.once = {0, 1, 2, 3};
    design.warp.colour_order.once = {0, 1, 2, 3};
    design.warp.colours = {colour("#3f6fb0"), colour("#b0413f"), colour("#5a9b4a")};
    design.warp.density_ends_per_cm = 32;
    design.warp.ends_per_dent = 4;
    design.weft.density_picks_per_cm = 10;
    add(design, "outer-walls", tube_layers(6, {true, false, true}));
    add(design, "apart", tube_layers(6, {false, false, false}));
    add(design, "inner-wall", tube_layers(6, {false, true, false}));
    add(design, "half-cell", attached("outer-walls", "apart", Face::plus_x));
    add(design, "other-half", attached("inner-wall", "apart", Face::plus_x));
    add(design, "cell", attached("half-cell", "other-half", Face::plus_x));
    add(design, "tubes", tiled("cell", 1, 2));
    for (std::size_t row = 0; row < 24; ++row) {
        design.scene.pins.push_back({true, 4 * row});
        design.scene.pins.push_back({true, 4 * row + 3});
    }
    return design;
}

namespace {

/// TL013 has six wefts a row: 0 and 1 are the plies of the lower double cloth, 2 and 3 the lower and upper
/// section of the zigzag layer, 4 and 5 the plies of the upper double cloth. Of the five ends of a column end
/// 2 is the zigzag.
constexpr std::size_t tl013_rows = 16, tl013_columns = 8, zigzag_end = 2, upper_section_weft = 3;

/// Heights of the zigzag in the wrong version. Between the binding points below (1) and above (5) it should
/// cross the upper section at the same distance on its way up and down; here both crossings come one row
/// early.
constexpr std::array<std::size_t, 8> leaning_zigzag{1, 2, 4, 4, 5, 3, 3, 2};
constexpr std::array<std::size_t, 8> upright_zigzag{1, 2, 3, 4, 5, 4, 3, 2};

/// Neighbouring ends are half a zigzag apart, so that they cross like the struts of a girder, and each pair
/// starts an eighth later, so that in every row some end keeps the wefts of the two sections apart.
constexpr std::size_t zigzag_step(std::size_t row, std::size_t column) {
    constexpr std::array<std::size_t, 8> start{0, 4, 1, 5, 2, 6, 3, 7};
    return (row + start[column % 8]) % 8;
}

Stack tl013_stack(std::size_t i, std::size_t j) {
    const bool up = (i + j) % 2 == 0;
    // On a few points the inner ply of a double cloth binds the outer ply's weft: the plies are stitched. 3i + j is
    // even where i + j is.
    const auto stitched = [&](std::size_t point) { return (3 * i + j) % 8 == point; };
    return cell(6, {at(up ? 1 : 0), at(up ? (stitched(4) ? 0 : 1) : 2), at(leaning_zigzag[zigzag_step(i, j)]),
                    at(up ? 4 : (stitched(3) ? 6 : 5)), at(up ? 6 : 5)});
}

Design tl013(std::string title, std::string notes) {
    Design design = cloth(std::move(title), std::move(notes), cotton("surface warp", "#e08a2c", 0.1, 25),
                          yarn("thick weft", "#8f959b", 0.3, 220, 500, 0.05));
    design.warp.yarns.push_back(yarn("zigzag monofilament", "#3f6fb0", 0.1, 40, 120, 0.02));
    design.warp.order.once = {0, 0, 1, 0, 0};
    design.warp.beams = {{"lower cloth"}, {"zigzag"}, {"upper cloth"}};
    design.warp.beam_order.once = {0, 0, 1, 2, 2};
    design.warp.density_ends_per_cm = 50;
    design.warp.ends_per_dent = 5;
    design.weft.density_picks_per_cm = 8;
    add(design, "tl013", stacks(tl013_rows, tl013_columns, 6, 5, tl013_stack));
    return design;
}

}  // namespace

Design tl013_wrong() {
    return tl013("TL013, wrong",
                 "Two double cloths joined by a zigzag layer, wefts three times as thick as the warp. The "
                 "error: on its way up and on its way down each zigzag end crosses the weft of the upper "
                 "section (pick 4 of the row) one row early, so the upper section leans. The weave of the "
                 "paper's TL013 is not printed; this one was built from its description and section.");
}

Design tl013_corrected() {
    Design design = tl013(
        "TL013, corrected",
        "The wrong version with two crossings of each zigzag end flipped in every zigzag: the ones with "
        "the weft of the upper section (pick 4 of the row) in the third and in the sixth row of the "
        "zigzag. Now it stands upright.");
    auto corrected = std::make_shared<Node>(*design.blocks.at("tl013"));
    for (std::size_t i = 0; i < tl013_rows; ++i) {
        for (std::size_t j = 0; j < tl013_columns; ++j) {
            const std::size_t step = zigzag_step(i, j);
            if (leaning_zigzag[step] == upright_zigzag[step]) continue;
            corrected->flips.push_back(
                {6 * i + upper_section_weft, 5 * j + zigzag_end, upright_zigzag[step] <= upper_section_weft});
        }
    }
    design.blocks["tl013"] = std::move(corrected);
    return design;
}

namespace {

constexpr std::size_t pocket_columns = 25, pocket_rows = 35, seam_rows = 5;

/// Weft 0 and end 0 are the back, weft 1 and end 1 the front; the front is a 2/3 satin, the back a 4/1 twill.
Stack pocket_stack(std::size_t i, std::size_t j) {
    const std::size_t satin = (j + 3 * i) % 5;
    return cell(2, {at((j + 5 - i) % 5 == 0 ? 1 : 0), at(satin < 2 ? 1 : 2)});
}

/// The back ends go over both wefts and under both, so the seam is one cloth; the front ends keep the two
/// picks of a row in different sheds, or the turn between them would not be caught.
Stack seam_stack(std::size_t i, std::size_t j) {
    static constexpr std::array<std::size_t, 4> front{1, 2, 0, 2};
    return cell(2, {at((i + j) % 2 == 0 ? 2 : 0), at(front[(i + j) % 4])});
}

}  // namespace

Design pocket() {
    Design design = cloth(
        "Pocket",
        "Two layers, open on one side only. One shuttle weaves back and front in turn, so its turns close "
        "both long sides; in the first five rows both layers are woven as one, which closes the bottom; the "
        "last row is the mouth. The spheres push it open. The weaves and the size of the open part follow "
        "the paper's user study (25 ends and 35 picks a layer, a 2/3 satin and a 4/1 twill); with the "
        "bottom a layer has 40 picks. The paper's figure does not print the weave.",
        cotton("front warp", "#e08a2c", 0.15, 50), cotton("weft", "#8f959b", 0.15, 50));
    design.warp.yarns.push_back(cotton("back warp", "#3f6fb0", 0.15, 50));
    design.warp.order.once = {1, 0};
    design.warp.density_ends_per_cm = 40;
    design.warp.ends_per_dent = 4;
    design.weft.density_picks_per_cm = 20;
    add(design, "layers", stacks(5, 5, 2, 2, pocket_stack));
    add(design, "body", tiled("layers", pocket_rows / 5, pocket_columns / 5));
    add(design, "seam", stacks(seam_rows, pocket_columns, 2, 2, seam_stack));
    add(design, "pocket", attached("body", "seam", Face::minus_x));

    Scene& scene = design.scene;
    scene.weft_mode = WeftMode::wraparound;
    scene.boundary_x = Boundary::frozen;
    scene.boundary_y = Boundary::free;
    scene.dx_mm = scene.dy_mm = 0.5;
    scene.dz_mm = 0.4;
    // Three spheres in a row between the layers, from the bottom of the pocket to its mouth.
    for (const double along : {9.0, 13.0, 17.0}) scene.fields.push_back({{along, 6.0, 0.6}, 3.0, 0.5});
    return design;
}

namespace {

/// Ten wefts a row: 0 to 2 the bottom flange, 3 to 6 the web, 7 to 9 the top flange. Thirteen ends a column:
/// four bind the bottom flange, five stand in the height of the web, four bind the top flange. All is woven
/// layer to layer.
constexpr std::size_t beam_wefts = 10, flange_wefts = 3, top_flange = 7;
constexpr std::size_t flange_ends = 4, web_ends = 5, beam_ends = 2 * flange_ends + web_ends;

std::array<End, beam_ends> beam_column(std::size_t i, std::size_t j) {
    const bool up = (i + j) % 2 == 0;
    std::array<End, beam_ends> ends;
    for (std::size_t k = 0; k < flange_ends; ++k) {
        const std::size_t height = up ? std::min(k + 1, flange_wefts) : std::max<std::size_t>(k, 1) - 1;
        ends[k] = at(height);
        ends[flange_ends + web_ends + k] = at(top_flange + height);
    }
    // The outermost ends of the web take in the inmost weft of a flange each. Whichever way the ends stand,
    // one of every column lies between any two wefts of the web, so each turn of its shuttle is caught by the
    // first column it meets.
    for (std::size_t k = 0; k < web_ends; ++k)
        ends[flange_ends + k] = at(flange_wefts + k + (up ? 1 : 0) - (up ? 0 : 1));
    return ends;
}

Stack web_stack(std::size_t i, std::size_t j) {
    return cell(beam_wefts, beam_column(i, j));
}

/// Beside the web all web picks lie between the flanges, under the same placeholder ends, so that nothing
/// holds them there.
Stack flange_stack(std::size_t i, std::size_t j) {
    std::array<End, beam_ends> ends = beam_column(i, j);
    for (std::size_t k = 0; k < web_ends; ++k) ends[flange_ends + k] = loose_at(top_flange);
    return cell(beam_wefts, ends, lowest(top_flange) & ~lowest(flange_wefts));
}

/// A row's wefts in the order of insertion, in rows 1, 3, … and in rows 2, 4, …. Beside the web a turn of its
/// shuttle slips in only past flange picks whose own turns there lie on the side of their flange: later turns
/// lie above earlier ones. So the top flange's three picks go where, on the side of the web's turn, the first
/// two turn and the third goes on to the next row; the bottom flange's where the first comes from the row
/// before. Three is odd, so this side changes from row to row. Rows 2, 4, … end with the top flange, so that
/// the last pick of all has no web turn round its tail.
constexpr std::array<std::array<std::size_t, beam_wefts>, 2> beam_order{
    {{0, 1, 2, 3, 7, 8, 9, 4, 5, 6}, {3, 0, 1, 2, 4, 5, 6, 7, 8, 9}}};

/// Adds two rows whose wefts are numbered from the bottom up, and the same in the order of insertion.
void add_in_order(Design& design, const std::string& name, NodePtr drawn) {
    add(design, name + "-drawn", std::move(drawn));
    const auto order = [](std::size_t row) {
        return std::vector<std::size_t>(beam_order[row].begin(), beam_order[row].end());
    };
    add(design, name + "-1", renumbered(name + "-drawn", 0, order(0)));
    add(design, name, renumbered(name + "-1", 1, order(1)));
}

/// The shuttles in that order: 0 the bottom flange's, 1 the web's, 2 the top flange's.
std::vector<FeederSet> beam_feeders() {
    std::vector<FeederSet> feeders;
    for (const auto& row : beam_order) {
        for (const std::size_t weft : row)
            feeders.push_back({weft < flange_wefts ? 0U : weft < top_flange ? 1U : 2U});
    }
    return feeders;
}

}  // namespace

Design i_beam() {
    Design design = cloth(
        "I-beam",
        "A carbon-fibre beam that is woven flat: two flanges over the whole width and a thin web in the "
        "middle. The shuttle of the web runs across, but its yarn turns round the outermost ends of the "
        "web, for beside it the ends (purple) are placeholders that bind nothing and are trimmed; only its "
        "first and last pick run out to the left edge. Each flange has a shuttle of its own, or its edges "
        "would be tied to the other flange, and its picks go in between those of the web where their turns "
        "do not catch the web's. Built after figure 14; the paper prints its card too small to be read.",
        roving("carbon warp", "#e08a2c", 0.25, 200),
        roving("carbon weft", "#8f959b", 0.25, 200));
    design.warp.beams = {{"flanges"}, {"web"}};
    design.warp.beam_order.once = {0, 0, 0, 0, 1, 1, 1, 1, 1, 0, 0, 0, 0};
    design.warp.colours = {colour("#7d3c98")};
    design.warp.density_ends_per_cm = 80;
    design.warp.ends_per_dent = 13;
    design.weft.density_picks_per_cm = 8;
    design.weft.feeders = {{"bottom flange", 0}, {"web", 0}, {"top flange", 0}};
    design.weft.feeder_order = beam_feeders();
    add_in_order(design, "flange-repeat", stacks(2, 2, beam_wefts, beam_ends, flange_stack));
    add_in_order(design, "web-repeat", stacks(2, 2, beam_wefts, beam_ends, web_stack));
    add(design, "web", tiled("web-repeat", 2, 2));
    add(design, "flanges", tiled("flange-repeat", 2, 4));
    add(design, "left-half", attached("flanges", "web", Face::plus_y));
    add(design, "beam", attached("left-half", "flanges", Face::plus_y));
    std::vector<std::uint32_t>& colours = design.warp.colour_order.once;
    colours.clear();
    for (std::size_t column = 0; column < 20; ++column) {
        const bool web = column >= 8 && column < 12;
        for (std::size_t end = 0; end < beam_ends; ++end) {
            const bool placeholder = !web && end >= flange_ends && end < flange_ends + web_ends;
            colours.push_back(placeholder ? 1 : 0);
        }
    }
    design.scene.weft_mode = WeftMode::wraparound;
    design.scene.boundary_y = Boundary::free;
    return design;
}

}  // namespace weave::sample
