#include <weave/picture/float_map.hpp>
#include <weave/picture/grid.hpp>
#include <weave/picture/layer_map.hpp>
#include <weave/picture/picture.hpp>
#include <weave/picture/slice_map.hpp>

#include <cstdlib>
#include <picture/pictures.hpp>
#include <support/random.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

std::string drawn(const Design& design, const Block& block, View view, PictureFormat format,
                  bool trim = false, std::size_t line = 0) {
    auto file = draw(design, cloth_of(block), {view, line, trim}, format);
    if (!file) FAIL(file.error().text());
    return *file;
}

Block wide_cloth(std::size_t rows, std::size_t columns) {
    Random random(7);
    std::vector<Stack> stacks;
    for (int k = 0; k < 12; ++k) stacks.push_back(random_stack(random, 1, 1, 1));
    std::vector<std::uint32_t> cells;
    for (std::size_t k = 0; k < rows * columns; ++k)
        cells.push_back(static_cast<std::uint32_t>(random.between(0, 11)));
    return Block::make(std::vector<std::uint32_t>(rows, 1), std::vector<std::uint32_t>(columns, 1), stacks,
                       cells)
        .value();
}

void check_card(const Block& block) {
    const Pixels pixels = read_pixels(drawn({}, block, View::card, PictureFormat::png));
    const Grid grid = card_grid(block);
    REQUIRE(grid.step == 1);
    const CardImage card = block.card_image();
    std::size_t wrong = 0;
    for (std::size_t pick = 0; pick < card.picks(); ++pick) {
        for (std::size_t end = 0; end < card.ends(); ++end) {
            const Colour wanted = card.weft_over(pick, end) ? Colour{255, 255, 255} : Colour{0, 0, 0};
            wrong += pixels.at(grid.centre(pick, end)) != wanted ? 1 : 0;
        }
    }
    CHECK(wrong == 0);
}

}  // namespace

TEST_CASE("every view is a whole PNG and a whole SVG") {
    const Design plain;
    Design turning = coloured_design();
    turning.scene.weft_mode = WeftMode::wraparound;
    Random random(3);
    const Block blocks[]{layered(), random_block(random), random_block(random, {}, {}, 14),
                         wide_cloth(70, 90), block_of({0, 2}, {0, 1}, {"", "P0", "T0 T1", "T1 P0 T0"})};
    for (const Block& block : blocks) {
        for (const View view : {View::card, View::face, View::back, View::floats, View::layers,
                                View::weft_slice, View::warp_slice, View::block}) {
            for (const Design* design : std::initializer_list<const Design*>{&plain, &turning}) {
                INFO("view " << static_cast<int>(view) << ", " << block.picks() << " x " << block.ends());
                const std::string png = drawn(*design, block, view, PictureFormat::png);
                const Pixels pixels = read_pixels(png);
                CHECK(pixels.at({1, 1}) == Colour{255, 255, 255});
                CHECK(pixels.width > 100);
                const std::string svg = drawn(*design, block, view, PictureFormat::svg);
                CHECK(is_well_formed(svg));
                CHECK(svg.find("width=\"" + std::to_string(pixels.width)) != std::string::npos);
                CHECK(svg.find("height=\"" + std::to_string(pixels.height)) != std::string::npos);
                CHECK(svg == drawn(*design, block, view, PictureFormat::svg));
            }
        }
    }
}

TEST_CASE("the XML check of these tests finds what is wrong") {
    CHECK(is_well_formed("<?xml?><a b=\"c\"><d/></a>"));
    CHECK_FALSE(is_well_formed("<a><b></a></b>"));
    CHECK_FALSE(is_well_formed("<a b=\"c></a>"));
    CHECK_FALSE(is_well_formed("<a></a><b></b>"));
}

TEST_CASE("card pictures show the card at every scale") {
    check_card(layered());
    check_card(wide_cloth(40, 33));      // large squares
    check_card(wide_cloth(130, 210));    // small squares with stack lines
    check_card(wide_cloth(300, 410));    // two pixels each
    check_card(wide_cloth(1500, 1000));  // one pixel each
}

TEST_CASE("cards too large for one pixel each are averaged") {
    const Block block = wide_cloth(8200, 9);
    const Pixels pixels = read_pixels(drawn({}, block, View::card, PictureFormat::png));
    const Grid grid = card_grid(block);
    REQUIRE(grid.step == 2);
    const CardImage card = block.card_image();
    for (const std::size_t pick : {0U, 4096U, 8198U}) {
        for (const std::size_t end : {0U, 4U, 8U}) {
            int over = 0, all = 0;
            for (std::size_t i = pick; i < pick + 2; ++i) {
                for (std::size_t j = end; j < std::min<std::size_t>(end + 2, 9); ++j, ++all)
                    over += card.weft_over(i, j) ? 1 : 0;
            }
            const Point corner{grid.corner.x + static_cast<double>(end / 2),
                               grid.corner.y + static_cast<double>(grid.height() - 1 - pick / 2)};
            CHECK(std::abs(pixels.at(corner).red - over * 255 / all) <= 1);
        }
    }
}

TEST_CASE("face and back show the outermost yarns, the back mirrored") {
    const Design design = coloured_design();
    for (const Block& block : {layered(), wide_cloth(20, 30), wide_cloth(300, 200), wide_cloth(1000, 1200)}) {
        for (const bool back : {false, true}) {
            const Pixels pixels =
                read_pixels(drawn(design, block, back ? View::back : View::face, PictureFormat::png));
            const Grid grid = face_grid(block, back);
            std::size_t wrong = 0;
            for (std::size_t row = 0; row < block.rows(); ++row) {
                for (std::size_t column = 0; column < block.columns(); ++column) {
                    auto slots = block.stack(row, column).slots();
                    std::size_t k = back ? 0 : slots.size() - 1;
                    while (slots[k].is_empty()) ++k;
                    const std::size_t end = block.first_end(column) + slots[k].index();
                    const Colour wanted =
                        slots[k].is_weft() ? design.weft.yarns[0].colour : design.warp.yarns[end % 2].colour;
                    wrong += pixels.at(grid.centre(row, column)) != wanted ? 1 : 0;
                }
            }
            CHECK(wrong == 0);
            CHECK((grid.centre(0, 0).x > grid.centre(0, 1).x) == back);
        }
    }
}

TEST_CASE("trimming looks through loose yarns") {
    const Design design = coloured_design();
    const Block block = layered();
    const Grid grid = face_grid(block, false);
    const Pixels whole = read_pixels(drawn(design, block, View::face, PictureFormat::png));
    const Pixels trimmed = read_pixels(drawn(design, block, View::face, PictureFormat::png, true));
    CHECK(whole.at(grid.centre(0, 0)) == design.weft.yarns[0].colour);    // T2~ lies on top
    CHECK(trimmed.at(grid.centre(0, 0)) == design.warp.yarns[1].colour);  // below it P1
    CHECK(drawn(design, block, View::block, PictureFormat::png) !=
          drawn(design, block, View::block, PictureFormat::png, true));
}

TEST_CASE("float lengths agree with counting from every place") {
    for_all(
        [](Random& random) {
            const Block block = random_block(random, {}, {}, 7);
            const Design design;
            const Subject subject{design, block, {}};
            const YarnColours colours(subject);
            const bool back = random.coin();
            const Surface surface(block, colours, back, random.coin());
            const auto lengths = float_lengths(surface);
            for (std::size_t row = 0; row < block.rows(); ++row) {
                for (std::size_t column = 0; column < block.columns(); ++column) {
                    const Slot yarn = surface.at(row, column);
                    const auto counts = [&](std::size_t i, std::size_t j) {
                        return i < block.rows() && j < block.columns() &&
                               surface.at(i, j).same_system(yarn) && surface.at(i, j).index() == yarn.index();
                    };
                    std::int32_t length = 1;
                    const bool weft = yarn.is_weft();
                    for (std::size_t k = 1; counts(row + (weft ? 0 : k), column + (weft ? k : 0)); ++k)
                        ++length;
                    for (std::size_t k = 1; counts(row - (weft ? 0 : k), column - (weft ? k : 0)); ++k)
                        ++length;
                    const std::int32_t wanted = yarn.is_empty() ? 0 : weft ? length : -length;
                    REQUIRE(lengths[row * block.columns() + column] == wanted);
                }
            }
        },
        property_cases());
}

TEST_CASE("the float picture colours each place by its float, wefts and warps apart") {
    const Design design;
    const Block block = wide_cloth(200, 150);
    const Subject subject{design, block, {}};
    const YarnColours colours(subject);
    const Pixels pixels = read_pixels(drawn(design, block, View::floats, PictureFormat::png));
    const FloatGrids grids = float_grids(block);
    std::size_t wrong = 0;
    for (const Grid& grid : {grids.face, grids.back}) {
        const auto lengths = float_lengths(Surface(block, colours, grid.mirrored, false));
        for (std::size_t row = 0; row < 200; ++row) {
            for (std::size_t column = 0; column < 150; ++column) {
                wrong +=
                    pixels.at(grid.centre(row, column)) != float_colour(lengths[row * 150 + column]) ? 1 : 0;
            }
        }
    }
    CHECK(wrong == 0);
    for (std::int32_t length = 1; length < 20; ++length) CHECK(float_colour(length) != float_colour(-length));
}

TEST_CASE("slices put dots and paths where the stacks say") {
    const Design design;
    const Block block = layered();
    const auto map_of = [&](View view, std::size_t line, bool trim) {
        const Subject subject{design, block, {view, line, trim}};
        const YarnColours colours(subject);
        return slice_map(subject, colours, WeftRuns(subject, colours));
    };
    const SliceMap warp = map_of(View::warp_slice, 2, false);
    REQUIRE(warp.dot_list.size() == 5);  // picks 1–3 of row 1, 4 and 5 of row 2
    for (const SliceDot& dot : warp.dot_list) {
        const std::size_t row = block.row_of_pick(dot.number);
        CHECK(dot.position == row);
        CHECK(block.stack(row, 2).positions(System::weft)[dot.number - block.first_pick(row)] == dot.level);
        CHECK(dot.loose == (dot.number == 2));
    }
    REQUIRE(warp.paths.size() == 2);
    CHECK(warp.paths[0].number == 3);
    CHECK(warp.paths[0].levels == std::vector<std::size_t>{0, 3});
    CHECK(warp.paths[1].levels == std::vector<std::size_t>{3, 1});
    CHECK(swaps(warp, warp.paths[0], 0));
    CHECK(map_of(View::warp_slice, 2, true).dot_list.size() == 4);
    const SliceMap weft = map_of(View::weft_slice, 0, false);
    CHECK(weft.dot_list.size() == 5);
    REQUIRE(weft.paths.size() == 3);
    CHECK(weft.paths[2].loose == std::vector<bool>{true, true, true});
    CHECK_FALSE(swaps(weft, weft.paths[2], 0));
}

TEST_CASE("slice pictures show dots in yarn colours and trim loose ones") {
    const Design design = coloured_design();
    const Block block = layered();
    const Subject subject{design, block, {View::warp_slice, 0, false}};
    const YarnColours colours(subject);
    const SliceMap map = slice_map(subject, colours, WeftRuns(subject, colours));
    const Pixels whole = read_pixels(drawn(design, block, View::warp_slice, PictureFormat::png));
    const Pixels trimmed = read_pixels(drawn(design, block, View::warp_slice, PictureFormat::png, true));
    for (const SliceDot& dot : map.dot_list) {
        Point left = slice_point(map, static_cast<double>(dot.position), static_cast<double>(dot.level));
        left.x -= 7.5;  // beside the number
        INFO("pick " << dot.number + 1);
        if (dot.loose) {
            CHECK(whole.at(left) != trimmed.at(left));
        } else {
            CHECK(whole.at(left) == design.weft.yarns[0].colour);
            CHECK(trimmed.at(left) == design.weft.yarns[0].colour);
        }
    }
}

TEST_CASE("views are named as people name them") {
    const Block block = layered();
    CHECK(parse_view("card", block)->view == View::card);
    CHECK(parse_view("block", block)->view == View::block);
    CHECK(parse_view("weft:3", block)->line == 0);
    CHECK(parse_view("weft:4", block)->line == 1);
    CHECK(parse_view("warp:5", block)->line == 2);
    for (const char* wrong : {"", "Card", "weft", "weft:", "weft:0", "weft:6", "warp:6", "warp:-1", "warp:1x",
                              "warp:99999999999999999999"}) {
        INFO(wrong);
        const auto request = parse_view(wrong, block);
        REQUIRE_FALSE(request);
        CHECK(request.error().code == ErrorCode::usage);
        CHECK_FALSE(request.error().message.empty());
    }
    CHECK_FALSE(draw({}, cloth_of(block), {View::weft_slice, 2, false}, PictureFormat::png));
    CHECK_FALSE(draw({}, {}, {}, PictureFormat::png));
}

TEST_CASE("titles from outside cannot break a picture") {
    Design design;
    design.title = "\xff\xfe <b>&\"\x01 " + std::string(5000, 'x');
    CHECK(is_well_formed(drawn(design, layered(), View::card, PictureFormat::svg)));
    CHECK(read_pixels(drawn(design, layered(), View::card, PictureFormat::png)).width < 2000);
    CHECK(printable("a\xc3\xa4\xe2\x82\xac") == "a\xc3\xa4\xe2\x82\xac");
    CHECK(printable("\xc0\x80\xed\xa0\x80") == "?????");
    CHECK(printable("abcdef", 3) == "abc…");
    CHECK_FALSE(Canvas::make(PictureFormat::png, 40000, 10));
    CHECK_FALSE(Canvas::make(PictureFormat::svg, std::nan(""), 10));
}

TEST_CASE("one stack as large as a cloth is still drawn, in part") {
    const Block block = make_block({3000}, {2000}, [](std::size_t, std::size_t) {
                            std::vector<Slot> slots;
                            for (std::size_t k = 0; k < 3000; ++k) slots.push_back(Slot::weft(k));
                            for (std::size_t k = 0; k < 2000; ++k) slots.push_back(Slot::warp(k));
                            return Stack(std::move(slots));
                        }).value();
    for (const View view : {View::layers, View::weft_slice, View::warp_slice, View::block}) {
        CHECK(read_pixels(drawn({}, block, view, PictureFormat::png)).width > 100);
    }
}
