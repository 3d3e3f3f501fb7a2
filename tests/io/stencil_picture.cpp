#include <weave/io/stencil_picture.hpp>

#include <catch2/catch.hpp>

using namespace weave;

TEST_CASE("the colours of a picture are counted, the most frequent first") {
    const Colour red{255, 0, 0}, blue{0, 0, 255}, white{255, 255, 255};
    const ColourImage image{2, 3, {white, red, red, blue, red, white}};
    REQUIRE(count_colours(image, 3).value() == std::vector<CountedColour>{{red, 3}, {white, 2}, {blue, 1}});
    REQUIRE_THAT(
        count_colours(image, 2).error().message,
        Catch::StartsWith("the picture has more than 2 colours") && Catch::Contains("reduce its colours"));
    REQUIRE(stencil_map(image, {{white, 0}, {red, 1}, {blue, 5}}).value() ==
            StencilMap{2, 3, {0, 1, 1, 5, 1, 0}});
    REQUIRE(
        stencil_map(image, {{white, 0}, {red, 1}}).error().message ==
        "the pixel in row 2 from the bottom and column 1 has the colour #0000ff, to which no block is given");
}
