// What pictures say and point at: numbers, names, arrows and turns, each at its place.

#include <weave/picture/float_map.hpp>
#include <weave/picture/grid.hpp>
#include <weave/picture/label_places.hpp>

#include <picture/slices.hpp>
#include <set>

using namespace weave;
using namespace weave::testing;

TEST_CASE("rulers number the pick and end that each row and column begins with") {
    const Block block = layered();  // rows of 3 and 2 picks, columns of 2, 1 and 2 ends
    const Grid grid = face_grid(block, false);
    const auto marks = marks_of({}, block, {.view = View::face});
    const auto stands_at = [&](const char* number, double Point::*axis, double wanted) {
        return std::ranges::any_of(places_of(marks, number),
                                   [&](Point place) { return std::abs(place.*axis - wanted) < 0.01; });
    };
    CHECK(stands_at("1", &Point::y, grid.centre(0, 0).y));
    CHECK(stands_at("4", &Point::y, grid.centre(1, 0).y));
    CHECK(stands_at("1", &Point::x, grid.centre(0, 0).x));
    CHECK(stands_at("3", &Point::x, grid.centre(0, 1).x));
    CHECK(stands_at("4", &Point::x, grid.centre(0, 2).x));
}

TEST_CASE("a row without picks and a column without ends have no number on the rulers") {
    const Block block =
        block_of({1, 0, 2}, {1, 0, 2},
                 {"T0 P0", "T0", "P1 T0 P0", "P0", "-", "P0 P1", "T0 P0 T1", "T0 T1", "T0 P0 P1 T1"});
    for (const View view : {View::face, View::back, View::floats, View::layers}) {
        INFO(static_cast<int>(view));
        const auto marks = marks_of({}, block, {.view = view});
        const auto on_rulers = [&](const char* number, Anchor anchor) {
            return std::ranges::count_if(marks, [&](const Mark& mark) {
                return mark.kind == Mark::Kind::text && mark.text == number && mark.size == 10 &&
                       mark.anchor == anchor;
            });
        };
        const auto panels = on_rulers("1", Anchor::middle);
        CHECK(panels >= 1);
        CHECK(on_rulers("1", Anchor::end) == panels);
        CHECK(on_rulers("2", Anchor::middle) == panels);
        CHECK(on_rulers("2", Anchor::end) == panels);
    }
}

TEST_CASE("the card's arrows point at pick 1, at the bottom, and at end 1, at the left") {
    const Block block = layered();
    const Grid grid = card_grid(block);
    const auto marks = marks_of({}, block, {.view = View::card});
    REQUIRE(places_of(marks, "pick 1").size() == 1);
    CHECK(places_of(marks, "pick 1")[0].y == Approx(grid.centre(0, 0).y));
    const auto arrows = arrows_of(marks);
    REQUIRE(arrows.size() == 2);
    CHECK(arrows[0].points[0].y == Approx(grid.centre(0, 0).y));
    CHECK(arrows[0].direction.x == 1);
    CHECK(arrows[1].points[0].x == Approx(grid.centre(0, 0).x));
    CHECK(arrows[1].direction.y == -1);
    REQUIRE(places_of(marks, "1").size() == 2);
    CHECK(places_of(marks, "1")[0].y == Approx(grid.centre(0, 0).y));
    REQUIRE(places_of(marks, "5").size() == 2);
    CHECK(places_of(marks, "5")[0].y == Approx(grid.centre(4, 0).y));
    CHECK(places_of(marks, "end lifted (warp over weft)").size() == 1);
    CHECK(places_of(marks, "weft over warp").size() == 1);
}

TEST_CASE("arrows on the weft point the way of the shuttle") {
    const SlicePicture slice =
        slice_of(shuttle(WeftMode::periodic), there_and_back(), {.view = View::weft_slice});
    REQUIRE(slice.map.paths.size() == 2);
    CHECK_FALSE(slice.map.paths[0].leftwards);
    CHECK(slice.map.paths[1].leftwards);
    std::set<std::size_t> seen;
    for (const Mark& arrow : arrows_of(slice.marks)) {
        for (std::size_t k = 0; k < 2; ++k) {
            if (std::abs(arrow.points[0].y - slice.at(0, slice.map.paths[k].levels[0]).y) > 0.01) continue;
            if (arrow.points[0].x < slice.at(0, 0).x) continue;  // the one that says where the face is
            CHECK(arrow.direction.x == (k == 0 ? 1 : -1));
            seen.insert(k);
        }
    }
    CHECK(seen.size() == 2);
}

TEST_CASE("a slice turns where the yarn turns, from the pick before to the pick after") {
    // T0 under and T1 over all ends: the last end catches the loop at the right.
    const SlicePicture slice =
        slice_of(shuttle(WeftMode::wraparound), there_and_back(), {.view = View::weft_slice});
    const Point from = slice.at(7, 0), to = slice.at(7, 2);
    std::size_t turns = 0;
    for (const Mark& mark : slice.marks) {
        if (mark.kind != Mark::Kind::line || mark.points.size() != 4) continue;
        if (distance(mark.points[0], from) > 0.01 || distance(mark.points[3], to) > 0.01) continue;
        ++turns;
        CHECK_FALSE(mark.dashed);
        CHECK(mark.points[1].x > from.x + 20);
    }
    CHECK(turns == 2);  // the rim, and the yarn on it
    std::size_t upwards = 0;
    for (const Mark& arrow : arrows_of(slice.marks)) {
        if (arrow.points[0].x > from.x + 20) upwards += arrow.direction.y == -1 ? 1 : 100;
    }
    CHECK(upwards == 1);
    CHECK_FALSE(says(slice.marks, "not caught"));
}

TEST_CASE("a turn that nothing catches is a black dotted one, and said") {
    const Block block = block_of({2}, {1, 1, 1}, {"T0 T1 P0", "T0 T1 P0", "T0 T1 P0"});
    const SlicePicture slice = slice_of(shuttle(WeftMode::wraparound), block, {.view = View::weft_slice});
    CHECK(says(slice.marks, "Black dotted turns are not caught."));
    std::size_t dotted = 0;
    for (const Mark& mark : slice.marks) {
        const bool turn = mark.kind == Mark::Kind::line && mark.points.size() == 4 &&
                          distance(mark.points[0], slice.at(2, 0)) < 0.01;
        if (turn) dotted += mark.dashed ? 1 : 100;
    }
    CHECK(dotted == 1);
}

TEST_CASE("a slice tells of turns that nothing catches only where it shows one or the way out to it") {
    const Block block = block_of({2, 2, 1}, {1}, {"T0 P0 T1", "P0 T0 T1", "T0 P0"});
    Design design = shuttle(WeftMode::wraparound);
    const auto slice = [&](std::size_t row) {
        return slice_of(design, block, {.view = View::weft_slice, .line = row});
    };
    const auto black_ways = [](const SlicePicture& picture) {
        return std::ranges::count_if(picture.marks, [](const Mark& mark) {
            return mark.kind == Mark::Kind::text && mark.text.ends_with("(not caught)");
        });
    };
    const std::string note = "Black dotted turns are not caught.";
    const WeftWay way = weft_way(block.card_image(), pick_table(design, block));
    std::size_t caught = 0;
    for (std::size_t row = 0; row < block.rows(); ++row) {
        INFO("row " << row + 1);
        std::size_t turns = 0, outside = 0;
        for (const Turn& turn : way.turns) {
            const bool from = block.row_of_pick(turn.from_pick) == row,
                       to = block.row_of_pick(turn.to_pick) == row;
            if (turn.caught_by == CaughtBy::none) turns += from || to, outside += from != to;
        }
        caught += turns == 0;
        CHECK(says(slice(row).marks, note) == (turns > 0));
        CHECK(black_ways(slice(row)) == static_cast<std::ptrdiff_t>(outside));
    }
    CHECK(caught == 1);
}

TEST_CASE("dots and yarns of a slice bear the numbers of the card") {
    const Block block = layered();
    for (const PictureRequest request : {PictureRequest{.view = View::warp_slice, .line = 2},
                                         PictureRequest{.view = View::weft_slice, .line = 1}}) {
        const SlicePicture slice = slice_of({}, block, request);
        for (const SliceDot& dot : slice.map.dot_list) {
            const Point centre = slice.at(static_cast<double>(dot.position), dot.level);
            const auto places = places_of(slice.marks, std::to_string(dot.number + 1));
            CHECK(std::ranges::any_of(places, [&](Point place) { return distance(place, centre) < 0.01; }));
        }
        for (const SlicePath& path : slice.map.paths) {
            const double y = slice.at(0, path.levels.front()).y;
            const auto places = places_of(slice.marks, std::to_string(path.number + 1));
            CHECK(std::ranges::any_of(places, [&](Point place) {
                return std::abs(place.y - y) < 0.01 && place.x < slice.at(0, 0).x;
            }));
        }
    }
}

TEST_CASE("every yarn of the baby shoe's first row can be told and followed") {
    const Design design = sample_design("shoe-baby");
    const Evaluation cloth = evaluate(design).value();
    const SlicePicture slice = slice_of(design, *cloth.block, {.view = View::weft_slice});
    std::set<std::uint32_t> colours;
    for (const SlicePath& path : slice.map.paths) {
        colours.insert(pixel_of(path.colour));
        CHECK(places_of(slice.marks, std::to_string(path.number + 1)).size() >= 2);
    }
    CHECK(slice.map.paths.size() == 4);
    CHECK(colours.size() == 4);
    const auto arrows = arrows_of(slice.marks);
    for (std::size_t a = 0; a < arrows.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            // An arrow on its white rim has both tips close together; the rim is larger.
            if (arrows[a].size != 14 || arrows[b].size != 14) continue;
            CHECK(distance(arrows[a].points[0], arrows[b].points[0]) > 14);
        }
    }
}

TEST_CASE("words go where they cover least, and never over one another") {
    LabelPlaces places({0, 0, 100, 100});
    const Point wishes[]{{20, 20}, {50, 20}, {80, 20}, {20, 60}};
    const auto taken_at = [&](double x, double y) {
        const Rectangle place = places.take(20, 10, wishes);
        return place.x == x - 10 && place.y == y - 5;
    };
    places.add_disc({52, 22}, 5);
    CHECK(taken_at(20, 20));
    CHECK(taken_at(80, 20));
    const Point line[]{{0, 60}, {10, 60}, {20, 60}, {30, 60}};
    places.add_curve(line);
    CHECK(taken_at(20, 60));  // over a line rather than over a disc
    CHECK(taken_at(50, 20));
    const Point outside[]{{-5, 20}, {95, 60}};
    CHECK(places.take(20, 10, outside).x == -15);  // nowhere fits: the first of equals
}

TEST_CASE("slices and the block begin where they are asked to, and say so") {
    const Design design = sample_design("shoe-adult");
    const Evaluation cloth = evaluate(design).value();
    const Block& block = *cloth.block;
    PictureRequest request = parse_view("weft:3000", block).value();
    REQUIRE(show_span(request, block, {.from_end = 1081}));
    CHECK(request.first_column == block.column_of_end(1080));
    const SlicePicture slice = slice_of(design, block, request);
    CHECK(says(slice.marks, "Shown: columns 181–240 of 400, ends 1081–1440."));
    CHECK_FALSE(says(slice.marks, "levels"));  // all of them are shown
    CHECK(says(slice.marks, "columns, from end 1081 (along the weft)"));
    for (const SliceDot& dot : slice.map.dot_list) {
        const std::size_t column = block.column_of_end(dot.number);
        REQUIRE(column == slice.map.begin + dot.position);
        REQUIRE(block.stack(request.line, column).slots()[dot.level].index() ==
                dot.number - block.first_end(column));
    }
    for (const SlicePath& path : slice.map.paths) {
        const std::size_t index = path.number - block.first_pick(request.line);
        for (std::size_t k = 0; k < path.levels.size(); ++k) {
            const Stack& stack = block.stack(request.line, slice.map.begin + path.first + k);
            REQUIRE(stack.positions(System::weft)[index] == path.levels[k]);
        }
    }
    PictureRequest whole{.view = View::block};
    REQUIRE(show_span(whole, block, {.from_pick = 3000, .from_end = 1081}));
    const auto marks = marks_of(design, block, whole);
    CHECK(says(marks, "Shown: rows 500–511 of 1000, columns 181–192 of 400."));
    CHECK(places_of(marks, "pick 2995").size() == 1);
    CHECK(places_of(marks, "end 1081").size() == 1);
    CHECK(places_of(marks, "2995").size() == 1);
    CHECK(places_of(marks, "1081").size() == 1);
}

TEST_CASE("a yarn that turns before the shown part runs in from its edge") {
    const Design design = shuttle(WeftMode::wraparound);
    const SlicePicture slice =
        slice_of(design, there_and_back(), {.view = View::weft_slice, .first_column = 3});
    REQUIRE(slice.map.positions == 5);
    for (const SlicePath& path : slice.map.paths) {
        CHECK(path.first == 0);
        CHECK(path.last() == 4);
    }
    CHECK(places_of(slice.marks, "8").size() >= 1);  // the last column, and its end
    CHECK_FALSE(says(slice.marks, "Shown: the"));
    CHECK(says(slice.marks, "Shown: columns 4–8 of 8, ends 4–8."));
}

TEST_CASE("slices and the block end where they are asked to, whole rows and columns at a time") {
    const Design design = sample_design("shoe-adult");
    const Evaluation cloth = evaluate(design).value();
    const Block& block = *cloth.block;
    PictureRequest weft = parse_view("weft:3000", block).value(), warp = parse_view("warp:1200", block).value();
    REQUIRE(show_span(weft, block, {.from_end = 1081, .to_end = 1200}));
    CHECK(says(slice_of(design, block, weft).marks, "Shown: columns 181–200 of 400, ends 1081–1200."));
    REQUIRE(show_span(weft, block, {.from_end = 1, .to_end = 2400}));  // no more than there is room for
    CHECK(says(slice_of(design, block, weft).marks, "Shown: columns 1–60 of 400, ends 1–360."));
    const auto pick = block.first_pick(500) + 1;  // the first of its row
    REQUIRE(show_span(warp, block, {.from_pick = pick, .to_pick = pick}));
    CHECK(says(slice_of(design, block, warp).marks, "Shown: row 501 of 1000, picks " + std::to_string(pick) + "–" +
                                                        std::to_string(block.first_pick(501)) + "."));
}

TEST_CASE("only views that begin somewhere can begin elsewhere") {
    const Block block = layered();
    for (const View view : {View::card, View::face, View::back, View::floats, View::layers}) {
        PictureRequest request{.view = view};
        CHECK(show_span(request, block, {}));
        for (const PictureSpan& span : {PictureSpan{.from_pick = 1}, PictureSpan{.to_pick = 1}, PictureSpan{.from_end = 1}, PictureSpan{.to_end = 1}})
            CHECK(show_span(request, block, span).error().code == ErrorCode::usage);
    }
    PictureRequest weft{.view = View::weft_slice}, warp{.view = View::warp_slice}, whole{.view = View::block};
    const auto refusal = [&](PictureRequest& request, const PictureSpan& span) { return show_span(request, block, span).error().message; };
    CHECK(refusal(weft, {.from_pick = 1}) == "only warp slices and the block can begin or end at a chosen pick");
    CHECK(refusal(warp, {.to_end = 1}) == "only weft slices and the block can begin or end at a chosen end");
    CHECK(refusal(whole, {.from_pick = 6, .from_end = 1}) == "there is no such pick as 6: the cloth has 1 to 5");
    CHECK(refusal(whole, {.from_pick = 1, .to_end = 0}) == "there is no such end as 0: the cloth has 1 to 5");
    CHECK(refusal(whole, {.from_end = 4, .to_end = 3}) == "a picture from end 4 cannot end at end 3");
    CHECK(show_span(whole, block, {.from_pick = 4, .to_pick = 4, .from_end = 3}));
    CHECK(whole.first_row == 1);
    CHECK(whole.last_row == 1);
    CHECK(whole.first_column == 1);
    CHECK(whole.last_column == PictureRequest::no_limit);
    CHECK_FALSE(draw({}, cloth_of(block), {.view = View::block, .first_row = 2}, PictureFormat::png));
    CHECK_FALSE(draw({}, cloth_of(block), {.view = View::block, .first_row = 1, .last_row = 0}, PictureFormat::png));
}

TEST_CASE("a tall block says how much of its height is shown, a wide one does not") {
    const Block tall = block_of({1}, {60}, {[] {
                                    std::string stack = "T0";
                                    for (int end = 0; end < 60; ++end) stack += " P" + std::to_string(end);
                                    return stack;
                                }()});
    CHECK(says(marks_of({}, tall, {.view = View::weft_slice}), "Shown: the lowest 48 of 61 levels."));
    const auto marks =
        marks_of({},
                 make_block(std::vector<std::uint32_t>(3, 1), std::vector<std::uint32_t>(70, 1),
                            [](auto, auto) { return parse_stack("T0 P0").value(); })
                     .value(),
                 {.view = View::block});
    CHECK(says(marks, "Shown: columns 1–24 of 70."));
    CHECK_FALSE(says(marks, "3 of 3"));
}

TEST_CASE("no number in the block covers another or an arrow, and small blocks count from 1 throughout") {
    for (const char* name : {"pocket", "shoe-baby", "shoe-adult", "orthogonal", "i-beam"}) {
        INFO(name);
        const Design design = sample_design(name);
        const Evaluation cloth = evaluate(design).value();
        const auto marks = marks_of(design, *cloth.block, {.view = View::block});
        std::vector<Rectangle> taken;
        for (const Mark& mark : marks) {
            const bool number = mark.kind == Mark::Kind::text && mark.size == 12 && mark.bold &&
                                mark.anchor == Anchor::middle;
            if (!number) continue;
            const double half = Canvas::text_width(mark.text, 12, true) / 2;
            taken.push_back({mark.points[0].x - half, mark.points[0].y - 6, 2 * half, 12});
        }
        CHECK(taken.size() >= 8);
        for (std::size_t a = 0; a < taken.size(); ++a) {
            for (std::size_t b = 0; b < a; ++b) {
                CHECK((std::abs(taken[a].y - taken[b].y) >= 12 || taken[a].x >= taken[b].x + taken[b].width ||
                       taken[b].x >= taken[a].x + taken[a].width));
            }
            for (const Mark& arrow : arrows_of(marks)) {
                const Point tip = arrow.points[0];
                CHECK_FALSE((tip.x > taken[a].x && tip.x < taken[a].x + taken[a].width &&
                             tip.y > taken[a].y && tip.y < taken[a].y + 12));
            }
        }
        CHECK(places_of(marks, "pick 1").size() == 1);
        CHECK(places_of(marks, "1").size() >= 1);
    }
    const Evaluation cloth = evaluate(sample_design("orthogonal")).value();
    const auto marks = marks_of({}, *cloth.block, {.view = View::block});
    CHECK(places_of(marks, "T0").empty());
    CHECK(places_of(marks, "P0").empty());
    for (int k = 1; k <= 8; ++k) {
        CHECK(places_of(marks, "T" + std::to_string(k)).size() == 2);  // one in each column
        CHECK(places_of(marks, "P" + std::to_string(k)).size() == 2);
    }
}

TEST_CASE("the block's numbers stand at the yarns that bear them") {
    // One pick and one end a row and column, wefts on top: picks count to the back, ends to the right.
    const Block block =
        make_block({1, 1, 1}, {1, 1, 1}, [](auto, auto) { return parse_stack("P0 T0").value(); }).value();
    const auto marks = marks_of({}, block, {.view = View::block});
    std::vector<Point> left, front,
        right;  // ends of the picks, the near ends of the ends, from first to last
    for (const char* number : {"1", "2", "3"}) {
        auto places = places_of(marks, number);
        REQUIRE(places.size() == 4);  // both ends of a pick and of an end
        std::ranges::sort(places, {}, &Point::x);
        left.push_back(places[0]), right.push_back(places[3]);
        front.push_back(places[1].y > places[2].y ? places[1] : places[2]);
    }
    for (std::size_t k = 1; k < 3; ++k) {
        CHECK((left[k].x > left[k - 1].x && left[k].y < left[k - 1].y));
        CHECK((right[k].x > right[k - 1].x && right[k].y < right[k - 1].y));
        CHECK((front[k].x > front[k - 1].x && front[k].y > front[k - 1].y));
    }
}

TEST_CASE("the block names its turns by the picks before and after, at their side") {
    const auto marks = marks_of(shuttle(WeftMode::wraparound), there_and_back(), {.view = View::block});
    REQUIRE(places_of(marks, "1→2").size() == 1);
    for (const char* end : {"1", "8"}) {  // numbers of the outermost ends, both left of the turn
        for (const Point place : places_of(marks, end)) CHECK(place.x < places_of(marks, "1→2")[0].x);
    }
    CHECK_FALSE(says(marks_of(shuttle(WeftMode::periodic), there_and_back(), {.view = View::block}), "→"));
}

TEST_CASE("every word stands on the page") {
    for (const char* name : {"orthogonal", "tl013-wrong", "shoe-baby", "i-beam", "plain", "pocket"}) {
        const Design design = sample_design(name);
        const Evaluation cloth = evaluate(design).value();
        for (const View view : {View::card, View::face, View::back, View::floats, View::layers,
                                View::weft_slice, View::warp_slice, View::block}) {
            INFO(name << ", view " << static_cast<int>(view));
            const Pixels pixels =
                read_pixels(draw(design, cloth, {.view = view}, PictureFormat::png).value());
            for (const Mark& mark : marks_of(design, *cloth.block, {.view = view})) {
                if (mark.kind != Mark::Kind::text) continue;
                INFO(mark.text);
                const double width = Canvas::text_width(mark.text, mark.size, mark.bold);
                const double left = mark.points[0].x - (mark.anchor == Anchor::start    ? 0
                                                        : mark.anchor == Anchor::middle ? width / 2
                                                                                        : width);
                CHECK(left >= 0);
                CHECK(left + width <= static_cast<double>(pixels.width));
                CHECK(mark.points[0].y <= static_cast<double>(pixels.height));
            }
        }
    }
}
