#include <weave/samples/build.hpp>
#include <weave/samples/makers.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weave::sample {

namespace {

constexpr std::size_t modulo(std::ptrdiff_t value, std::ptrdiff_t size) {
    return static_cast<std::size_t>((value % size + size) % size);
}
constexpr std::ptrdiff_t whole(std::size_t value) {
    return static_cast<std::ptrdiff_t>(value);
}

/// Two-layer cloths have weft 0 and end 0 in the back layer, weft 1 and end 1 in the face layer.
Design two_layers(std::string title, std::string notes) {
    Design design =
        cloth(std::move(title), std::move(notes), cotton("face warp", "#e08a2c"), cotton("weft", "#8f959b"));
    design.warp.yarns.push_back(cotton("back warp", "#3f6fb0"));
    design.warp.order.once = {1, 0};
    design.warp.beams = {{"back"}, {"face"}};
    design.warp.beam_order.once = {0, 1};
    design.warp.density_ends_per_cm = 40;
    design.warp.ends_per_dent = 4;
    design.weft.density_picks_per_cm = 20;
    return design;
}

/// A block of warp slices side by side: column j holds the ends at `height(i, j, e)` among the wefts of row
/// i.
template <class HeightOfEnd>
void add_slices(Design& design, const std::string& name, std::size_t rows, std::size_t columns,
                std::size_t wefts, std::size_t ends, HeightOfEnd height) {
    std::string so_far;
    for (std::size_t j = 0; j < columns; ++j) {
        std::vector<Stack> stacks;
        for (std::size_t i = 0; i < rows; ++i) {
            std::vector<End> heights;
            for (std::size_t e = 0; e < ends; ++e) heights.push_back(at(height(i, j, e)));
            stacks.push_back(cell(wefts, heights));
        }
        const std::string slice = "slice-" + std::to_string(j + 1);
        add(design, slice, warp_slice_of(stacks));
        const std::string joined = j + 1 == columns ? name : name + "-1-to-" + std::to_string(j + 1);
        if (j > 0) add(design, joined, attached(so_far, slice, Face::plus_y));
        so_far = j > 0 ? joined : slice;
    }
}

Design composite(std::string title, std::string notes) {
    Design design = cloth(std::move(title), std::move(notes), roving("binder", "#e08a2c", 0.2, 200),
                          roving("filling", "#8f959b", 0.25, 300));
    design.warp.density_ends_per_cm = 20;
    design.weft.density_picks_per_cm = 8;
    return design;
}

}  // namespace

Design satin_e() {
    Design design = two_layers(
        "Satin E: two-layer satin",
        "Both layers are 5-end satins that show their warp outside. Every other binding point of a "
        "back end is raised over the face pick, where its neighbours float and hide it, so that "
        "the layers hold together.");
    add(design, "satin-e", stacks(10, 5, 2, 2, [](std::size_t i, std::size_t j) {
            const bool face_binds = j == 2 * i % 5;
            const bool back_binds = j == (2 * i + 2) % 5;
            const std::size_t back = back_binds ? (i % 2 == 0 ? 2 : 1) : 0;
            return cell(2, {at(back), at(face_binds ? 1 : 2)});
        }));
    return design;
}

Design twill_g() {
    Design design =
        two_layers("Twill G: two-layer twill",
                   "A 3/1 twill on the face and a 1/3 twill behind it. The back ends rise over the face "
                   "picks along every other twill line, which draws the face in to a diagonal dent.");
    add(design, "twill-g", stacks(8, 8, 2, 2, [](std::size_t i, std::size_t j) {
            const std::ptrdiff_t line = whole(j) - whole(i);
            const std::size_t back = modulo(line, 8) == 2 ? 2 : modulo(line, 4) == 2 ? 1 : 0;
            return cell(2, {at(back), at(modulo(line, 4) == 0 ? 1 : 2)});
        }));
    return design;
}

namespace {

/// A two-layer satin with this weft in the face layer: the face shows the weft, or, warp-faced, the warp.
NodePtr colour_satin(std::size_t face_weft, bool warp_faced) {
    return stacks(5, 5, 2, 2, [=](std::size_t i, std::size_t j) {
        const Below face = Below{1} << face_weft, back = 3U & ~face;
        const bool face_binds = j == 2 * i % 5, back_binds = j == (2 * i + 2) % 5;
        const End face_end{back | (face_binds != warp_faced ? face : 0U)};
        return cell(2, {End{back_binds ? 0U : back}, face_end});
    });
}

/// A flower: petals of colour 0 on a ground of colour 2, with an eye of colour 1.
StencilMap flower(std::size_t size) {
    StencilMap map{size, size, {}};
    const double middle = static_cast<double>(size) / 2;
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t j = 0; j < size; ++j) {
            const double x = static_cast<double>(j) + 0.5 - middle, y = static_cast<double>(i) + 0.5 - middle;
            const double radius = std::hypot(x, y) / middle, turn = std::atan2(x, y);
            const double petal = 0.62 + 0.26 * std::cos(5 * turn);
            map.blocks.push_back(radius < 0.24 ? 1 : radius < petal ? 0 : 2);
        }
    }
    return map;
}

}  // namespace

Design three_colour_stencil() {
    Design design = cloth(
        "Three-colour stencil",
        "Figure 1 of the paper: three two-layer satins, each with another colour on the face, merged "
        "by a stencil image. The layers change places along the outlines of the image, which joins them.",
        cotton("white warp", "#efe6d2"), cotton("red", "#c0392b"));
    design.weft.yarns.push_back(cotton("blue", "#2f5d9b"));
    design.weft.feeders = {{"red", 0}, {"blue", 1}};
    design.weft.feeder_order = {{0}, {1}};
    design.warp.density_ends_per_cm = 40;
    design.warp.ends_per_dent = 4;
    add(design, "red", colour_satin(0, false));
    add(design, "blue", colour_satin(1, false));
    add(design, "white", colour_satin(1, true));
    add(design, "cloth", stencilled({"red", "blue", "white"}, flower(50)));
    return design;
}

Design layer_to_layer() {
    Design design = composite(
        "Layer to layer",
        "Four levels of wefts and five ends a column. Each of the three inner ends binds two neighbouring "
        "levels: it rises over both, comes back between them and dives under both. The lowest and the "
        "highest end bind one level each, the bottom and the top one. Neighbouring slices are half a "
        "repeat apart.");
    static constexpr std::ptrdiff_t step[] = {1, 0, -1, 0};
    add_slices(design, "layer-to-layer", 4, 2, 4, 5, [](std::size_t i, std::size_t j, std::size_t e) {
        const std::ptrdiff_t height = whole(e) + step[(i + 2 * j) % 4];
        return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(height, 0, 4));
    });
    return design;
}

Design angle_interlock_a() {
    Design design =
        composite("Angle interlock A",
                  "Through the thickness: every end crosses all four levels of wefts on a slant, from one "
                  "face to the other and back, and there is no other warp.");
    static constexpr std::size_t height[] = {0, 0, 1, 2, 3, 4, 4, 3, 2, 1};
    add_slices(design, "angle-interlock-a", 10, 10, 4, 1,
               [](std::size_t i, std::size_t j, std::size_t) { return height[(i + 3 * j) % 10]; });
    return design;
}

Design angle_interlock_b() {
    Design design =
        composite("Angle interlock B",
                  "Three levels of wefts, binders on a slant from face to face, and beside each binder two "
                  "straight stuffer ends, one between the lower and one between the upper two levels.");
    design.warp.yarns.push_back(roving("stuffer", "#3f6fb0", 0.25, 300));
    design.warp.order.once = {1, 1, 0};
    design.warp.beams = {{"binders"}, {"stuffers"}};
    design.warp.beam_order.once = {1, 1, 0};
    static constexpr std::size_t height[] = {0, 0, 1, 2, 3, 3, 2, 1};
    add_slices(design, "angle-interlock-b", 8, 8, 3, 3, [](std::size_t i, std::size_t j, std::size_t e) {
        return e < 2 ? e + 1 : height[(i + 3 * j) % 8];
    });
    return design;
}

Design orthogonal() {
    Design design =
        composite("Orthogonal",
                  "Four levels of wefts and three straight stuffer ends between them; a binder stands "
                  "upright between its turns over the top and under the bottom weft.");
    design.warp.yarns.push_back(roving("stuffer", "#3f6fb0", 0.25, 300));
    design.warp.order.once = {1, 1, 1, 0};
    design.warp.beams = {{"stuffers"}, {"binders"}};
    design.warp.beam_order.once = {0, 0, 0, 1};
    add_slices(design, "orthogonal", 2, 2, 4, 4, [](std::size_t i, std::size_t j, std::size_t e) {
        return e < 3 ? e + 1 : (i + j) % 2 == 0 ? std::size_t{4} : std::size_t{0};
    });
    return design;
}

Design stitched_layers() {
    Design design =
        composite("Four stitched layers",
                  "Four plain-weave layers, each with its own wefts and ends. On a satin of points an end "
                  "of a layer dives under the weft of the layer below it, which stitches the two together.");
    add_slices(design, "stitched-layers", 8, 8, 4, 4, [](std::size_t i, std::size_t j, std::size_t e) {
        const bool up = (i + j) % 2 == 0;
        const bool stitches = e > 0 && modulo(3 * whole(i) - whole(j) + 2 * whole(e), 8) == 1;
        return up ? e + 1 : stitches ? e - 1 : e;
    });
    return design;
}

}  // namespace weave::sample
