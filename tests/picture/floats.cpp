// What the float map says in words.

#include <weave/picture/float_map.hpp>

#include <picture/pictures.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

/// Weft floats of 3 on the face, and on the back warp floats of 2.
Block floating() {
    return block_of({1, 1, 1}, {1, 1, 1, 1},
                    {"P0 T0", "P0 T0", "P0 T0", "T0 P0",  //
                     "P0 T0", "T0 P0", "P0 T0", "P0 T0",  //
                     "T0 P0", "P0 T0", "T0 P0", "P0 T0"});
}

}  // namespace

TEST_CASE("each panel of the float map names its own longest floats above itself") {
    const Block block = floating();
    const auto marks = marks_of({}, block, {.view = View::floats});
    const FloatGrids grids = float_grids(block);
    const auto face = places_of(marks, "Face: longest weft float 3, warp float 1");
    const auto back = places_of(marks, "Back, seen from behind: longest weft float 1, warp float 2");
    REQUIRE(face.size() == 1);
    REQUIRE(back.size() == 1);
    CHECK(face[0].x == grids.face.corner.x);
    CHECK(back[0].x == grids.back.corner.x);
    CHECK(grids.face.corner.x < grids.back.corner.x);
}

TEST_CASE("floats of loose yarns are no floats of the cloth") {
    const Design design = sample_design("shoe-baby");
    const Evaluation cloth = evaluate(design).value();
    const auto marks = marks_of(design, *cloth.block, {.view = View::floats});
    CHECK(says(marks, "Face: longest weft float 2, warp float 0"));
    CHECK(says(marks, "without the yarns that are loose on purpose"));
    CHECK_FALSE(says(marks_of({}, floating(), {.view = View::floats}), "loose"));
}
