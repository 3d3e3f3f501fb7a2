// Changes too small to be seen where a whole card is looked at are ringed; the others are not.

#include <weave/picture/change_rings.hpp>
#include <weave/picture/diff_view.hpp>

#include <picture/pictures.hpp>
#include <support/random.hpp>

using namespace weave;
using weave::testing::for_all;
using weave::testing::Pixels;
using weave::testing::Random;
using weave::testing::read_pixels;
using weave::testing::says;

namespace {

using Places = std::vector<std::pair<std::size_t, std::size_t>>;

Grid grid_of(std::size_t picks, std::size_t ends) {
    return make_grid(picks, ends, 28, 900);
}

std::vector<Ring> rings_of(const Grid& grid, const Places& changed) {
    ChangeRings rings(grid);
    for (const auto& [row, column] : changed) rings.add(row, column);
    return rings.rings();
}

bool holds(const Ring& ring, Point point) {
    return std::hypot(point.x - ring.centre.x, point.y - ring.centre.y) < ring.radius;
}

/// A plain weave of this size, with crossings changed.
WovenDesign plain(std::size_t picks, std::size_t ends, const Places& changed) {
    WovenDesign woven;
    woven.cloth.emplace();
    CardImage card(picks, ends);
    for (std::size_t pick = 0; pick < picks; ++pick)
        for (std::size_t end = 0; end < ends; ++end) card.set(pick, end, (pick + end) % 2 == 0);
    for (const auto& [pick, end] : changed) card.set(pick, end, !card.weft_over(pick, end));
    woven.cloth->card = std::move(card);
    return woven;
}

/// The picture of a plain weave and the same with crossings changed, and whether its legend tells of rings.
struct Compared {
    Pixels pixels;
    bool tells = false;
};
Compared compared(std::size_t picks, std::size_t ends, const Places& changed) {
    const WovenDesign before = plain(picks, ends, {}), after = plain(picks, ends, changed);
    DesignDiff diff;
    diff.card = diff_cards(before.cloth->card, after.cloth->card);
    std::vector<Mark> marks;
    const std::string file = draw_diff(before, after, diff, PictureFormat::png, {.marks = &marks}).value();
    REQUIRE(draw_diff(before, after, diff, PictureFormat::svg));
    return {read_pixels(file), says(marks, "ring round changes too small")};
}

/// Where the picture is black, which rings alone are, in the part that shows the card.
std::vector<Point> black_in(const Pixels& pixels, const Grid& grid) {
    std::vector<Point> points;
    for (std::size_t y = 0; y < grid.height(); ++y)
        for (std::size_t x = 0; x < grid.width(); ++x) {
            const Point point{grid.corner.x + static_cast<double>(x), grid.corner.y + static_cast<double>(y)};
            if (pixels.at(point) == Colour{0, 0, 0}) points.push_back(point);
        }
    return points;
}

}  // namespace

TEST_CASE("one changed crossing of a large card gets a ring that is seen beside it") {
    const Grid grid = grid_of(6000, 2400);
    const auto rings = rings_of(grid, {{5102, 1046}});
    REQUIRE(rings.size() == 1);
    CHECK(rings[0].centre.x == Approx(grid.centre(5102, 1046).x));
    CHECK(rings[0].centre.y == Approx(grid.centre(5102, 1046).y));
    CHECK(rings[0].radius >= 6000 / 100);
    CHECK(ChangeRings(grid).line() >= 6000 / 600);
}

TEST_CASE("a comparison to stand beside words is small whatever the cards, with numbers as large as any, and as fine as asked for") {
    for (const auto& [picks, ends] : {std::pair<std::size_t, std::size_t>{6000, 2400}, {30, 40}}) {
        const WovenDesign before = plain(picks, ends, {}), after = plain(picks, ends, {{17, 12}});
        DesignDiff diff;
        diff.card = diff_cards(before.cloth->card, after.cloth->card);
        for (const int scale : {1, 2}) {
            INFO(picks << " picks, scale " << scale);
            std::vector<Mark> marks;
            const DiffLook look{.wanted_side = 240, .longest_side = 240, .scale = scale, .has_words = false, .marks = &marks};
            const Pixels pixels = read_pixels(draw_diff(before, after, diff, PictureFormat::png, look).value());
            CHECK(pixels.width <= static_cast<std::size_t>(480 * scale));
            CHECK(pixels.height <= static_cast<std::size_t>(520 * scale));
            const auto is_number = [](const Mark& mark) { return mark.kind == Mark::Kind::text && mark.text.find_first_not_of("0123456789") == std::string::npos; };
            REQUIRE(std::ranges::any_of(marks, is_number));
            for (const Mark& mark : marks) CHECK((!is_number(mark) || mark.size >= 10));
            CHECK(says(marks, "end lifted"));
            CHECK_FALSE(says(marks, "card image compared"));
            // Drawn whole: the frame's lower right corner is where it was, so many times as far.
            const Grid grid = make_grid(picks, ends, 28, 240, 240);
            const double right = scale * (Page::margin + grid_left + static_cast<double>(grid.width())), middle = scale * (Page::margin + 26 + 10.0);
            bool is_framed = false;
            for (int x = -scale; x <= scale; ++x) is_framed = is_framed || pixels.at({right + x, middle}).red < 0x90;
            CHECK(is_framed);
        }
    }
}

TEST_CASE("every change of some scattered at random lies in a ring") {
    const auto scattered = [](Random& random) {
        const Grid grid = grid_of(random.between(300, 20000), random.between(300, 20000));
        Places places;
        for (std::size_t k = random.between(1, 12); k > 0; --k)
            places.emplace_back(random.between(0, grid.rows - 1), random.between(0, grid.columns - 1));
        const auto rings = rings_of(grid, places);
        INFO(grid.rows << " x " << grid.columns);
        for (const auto& [row, column] : places)
            CHECK(std::ranges::any_of(
                rings, [&](const Ring& ring) { return holds(ring, grid.centre(row, column)); }));
    };
    for_all(scattered, 300);
}

TEST_CASE("changes close by share a ring, which holds them all") {
    const Grid grid = grid_of(6000, 2400);
    const Places places{{3000, 1000}, {3000, 1040}, {3030, 1000}};
    const auto rings = rings_of(grid, places);
    REQUIRE(rings.size() == 1);
    for (const auto& [row, column] : places) CHECK(holds(rings[0], grid.centre(row, column)));
    CHECK(rings_of(grid, {{3000, 1000}, {3000, 1400}}).size() == 2);
    for (std::size_t apart = 1; apart < 1000; apart += 7) {  // no two are lost, however far apart they are
        const auto two = rings_of(grid, {{3000, 1000}, {3000, 1000 + apart}});
        for (const std::size_t end : {std::size_t{1000}, 1000 + apart}) {
            INFO(apart);
            CHECK(std::ranges::any_of(two,
                                      [&](const Ring& ring) { return holds(ring, grid.centre(3000, end)); }));
        }
    }
}

TEST_CASE("what is large enough to be seen has no ring, nor has a card that would be hidden by rings") {
    const Grid large = grid_of(6000, 2400), small = grid_of(8, 8);
    CHECK(rings_of(small, {{3, 3}}).empty());
    Places patch, all, lattice;
    for (std::size_t row = 0; row < 6000; row += 3)
        for (std::size_t column = 0; column < 2400; column += 3) {
            all.emplace_back(row, column);
            if (row < 120 && column < 120) patch.emplace_back(row, column);
            if (row % 201 == 0 && column % 201 == 0) lattice.emplace_back(row, column);
        }
    CHECK(rings_of(large, patch).empty());
    patch.emplace_back(4000, 2000);
    CHECK(rings_of(large, patch).size() == 1);
    CHECK(rings_of(large, all).empty());
    REQUIRE(lattice.size() == 360);
    CHECK(rings_of(large, lattice).empty());
    lattice.resize(60);
    CHECK(rings_of(large, lattice).size() == 60);
}

TEST_CASE("a compared card is drawn with rings where they help, and says so") {
    const Compared one = compared(1200, 900, {{700, 300}});
    CHECK(one.tells);
    Grid grid = grid_of(1200, 900);
    grid.corner.y = 100;  // below the bars
    const auto black = black_in(one.pixels, grid);
    CHECK(black.size() > 50);
    const Ring ring = rings_of(grid, {{700, 300}}).front();
    for (const Point point : black) {
        const double from = std::hypot(point.x - ring.centre.x, point.y - ring.centre.y);
        CHECK(std::abs(from - ring.radius) < ChangeRings(grid).line());
    }
    CHECK(one.pixels.at(grid.centre(700, 300)) == Colour{0x00, 0x72, 0xb2});  // which the ring does not hide

    const Compared same = compared(1200, 900, {});
    CHECK_FALSE(same.tells);
    CHECK(black_in(same.pixels, grid).empty());
    Places all;
    for (std::size_t pick = 0; pick < 1200; pick += 2)
        for (std::size_t end = 0; end < 900; end += 2) all.emplace_back(pick, end);
    const Compared everywhere = compared(1200, 900, all);
    CHECK_FALSE(everywhere.tells);
    CHECK(black_in(everywhere.pixels, grid).empty());
    CHECK_FALSE(compared(12, 12, {{3, 3}}).tells);
}
