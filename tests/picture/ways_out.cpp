// The ways by which yarns leave a slice: their words and lines can be read beside all else.

#include <weave/picture/label_places.hpp>

#include <algorithm>
#include <picture/slices.hpp>
#include <string>
#include <vector>

using namespace weave;
using namespace weave::testing;

namespace {

/// `to 41`, or with the yarn's own number, `40 to 41`.
bool is_way_out(const Mark& mark) {
    if (mark.kind != Mark::Kind::text) return false;
    const std::string words =
        mark.text.substr(std::min(mark.text.find_first_not_of("0123456789 "), mark.text.size()));
    return words.starts_with("to ") || words.starts_with("from ");
}

/// The short dotted line by which a yarn leaves.
bool is_stub(const Mark& mark) {
    return mark.kind == Mark::Kind::line && mark.dashed && mark.size == 2 && mark.points.size() == 2;
}

/// Where a word of a slice stands.
Rectangle box_of(const Mark& mark) {
    const double width = Canvas::text_width(mark.text, mark.size, mark.bold), height = mark.size * 0.8;
    const double share = mark.anchor == Anchor::start ? 0 : mark.anchor == Anchor::middle ? 0.5 : 1;
    return {mark.points[0].x - share * width, mark.points[0].y - height / 2, width, height};
}

bool overlap(const Rectangle& a, const Rectangle& b) {
    return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

/// No stub may run into words or dots, nor up to them as if it were another yarn's.
void check_stubs(const SlicePicture& slice) {
    for (const Mark& stub : slice.marks) {
        if (!is_stub(stub)) continue;
        const Point from = stub.points[0], to = stub.points[1];
        const double length = distance(from, to);
        for (double way = 9; way <= length + 8; ++way) {
            const Point point{from.x + (to.x - from.x) * way / length,
                              from.y + (to.y - from.y) * way / length};
            for (const Mark& other : slice.marks) {
                if (other.kind != Mark::Kind::text || is_way_out(other)) continue;
                INFO("the line runs into " << other.text);
                CHECK_FALSE(overlap(box_of(other), {point.x - 1, point.y - 1, 2, 2}));
            }
            for (const SliceDot& dot : slice.map.dot_list)
                CHECK(distance(point, slice.at(static_cast<double>(dot.position), dot.level)) > 10);
        }
    }
}

/// The words of ways out in this picture; none may cover another word or a dot.
std::size_t readable_ways_out(const Design& design, const Block& block, const std::string& view) {
    const SlicePicture slice = slice_of(design, block, parse_view(view, block).value());
    check_stubs(slice);
    std::size_t ways = 0;
    for (const Mark& mark : slice.marks) {
        if (!is_way_out(mark)) continue;
        ++ways;
        const Rectangle box = box_of(mark);
        INFO(view << ": " << mark.text);
        CHECK(box.x > 0);
        for (const Mark& other : slice.marks) {
            if (&other == &mark || other.kind != Mark::Kind::text) continue;
            INFO("and " << other.text);
            CHECK_FALSE(overlap(box, box_of(other)));
        }
        for (const SliceDot& dot : slice.map.dot_list) {
            const Point centre = slice.at(static_cast<double>(dot.position), dot.level);
            const Point near{std::clamp(centre.x, box.x, box.x + box.width),
                             std::clamp(centre.y, box.y, box.y + box.height)};
            CHECK(distance(near, centre) >= 10);
        }
    }
    return ways;
}

}  // namespace

TEST_CASE("where a yarn leaves a slice its way out can be read beside dots, turns and other words") {
    const struct {
        const char *sample, *view;
        std::size_t ways;
    } pictures[] = {{"shoe-baby", "weft:170", 2}, {"i-beam", "weft:1", 3}, {"shoe-toddler", "weft:300", 2}};
    for (const auto& [sample, view, ways] : pictures) {
        const Design design = sample_design(sample);
        const Evaluation cloth = evaluate(design).value();
        CHECK(readable_ways_out(design, *cloth.block, view) == ways);
    }
}

TEST_CASE("ways out of every row of the I-beam and of the small shoe can be read") {
    for (const char* sample : {"i-beam", "shoe-baby"}) {
        const Design design = sample_design(sample);
        const Evaluation cloth = evaluate(design).value();
        const Block& block = *cloth.block;
        std::size_t ways = 0;
        for (std::size_t row = 0; row < block.rows(); ++row)
            ways += readable_ways_out(design, block, "weft:" + std::to_string(block.first_pick(row) + 1));
        CHECK(ways > 2);
    }
}

TEST_CASE("a trimmed yarn leaves from where it is cut, not from where its loose part ended") {
    const Design design = sample_design("shoe-baby");
    const Evaluation cloth = evaluate(design).value();
    const Block& block = *cloth.block;
    std::size_t stubs = 0;
    for (std::size_t row = 0; row < block.rows(); ++row) {
        PictureRequest request =
            parse_view("weft:" + std::to_string(block.first_pick(row) + 1), block).value();
        request.trim = true;
        const SlicePicture slice = slice_of(design, block, request);
        for (const Mark& stub : slice.marks) {
            if (!is_stub(stub)) continue;
            ++stubs;
            INFO("row " << row + 1);
            CHECK(std::ranges::any_of(slice.marks, [&](const Mark& yarn) {
                if (yarn.kind != Mark::Kind::line || yarn.dashed || yarn.size < 5) return false;
                return distance(yarn.points.front(), stub.points[0]) < 0.01 ||
                       distance(yarn.points.back(), stub.points[0]) < 0.01;
            }));
        }
    }
    CHECK(stubs > 10);
}

TEST_CASE("a way out bears its own yarn's number where there is room for it") {
    const Design design = sample_design("shoe-baby");
    const Evaluation cloth = evaluate(design).value();
    const SlicePicture slice = slice_of(design, *cloth.block, parse_view("weft:40", *cloth.block).value());
    CHECK(places_of(slice.marks, "40 to 41").size() == 1);
    CHECK(places_of(slice.marks, "from 36").size() == 1);
}

TEST_CASE("a pick of two feeders that leave together says where each goes, once") {
    const Block block = block_of({1, 1, 1}, {1, 1, 1, 1},
                                 {"T0 P0", "T0 P0", "T0 P0", "T0 P0",  //
                                  "P0 T0", "T0 P0", "P0 T0", "T0 P0",  //
                                  "T0 P0", "T0 P0", "P0 T0", "T0 P0"});
    Design design = shuttle(WeftMode::wraparound);
    design.weft.feeders.push_back(design.weft.feeders[0]);
    design.weft.feeder_order = {{0, 1}, {0}, {1}};
    const SlicePicture slice = slice_of(design, block, {.view = View::weft_slice});
    CHECK(places_of(slice.marks, "1 to 2, to 3").size() == 1);
    CHECK(std::ranges::count_if(slice.marks, is_stub) == 1);
}

TEST_CASE("in a cloth of one column no arrow of the shuttle hides its short yarn") {
    const Block block = block_of({1, 1}, {2}, {"P0 T0 P1", "P1 T0 P0"});
    const SlicePicture leaving = slice_of(shuttle(WeftMode::wraparound), block, {.view = View::weft_slice});
    const auto shuttles = [](const SlicePicture& slice) {
        return std::ranges::count_if(arrows_of(slice.marks),
                                     [](const Mark& arrow) { return arrow.size == 14; });
    };
    CHECK(places_of(leaving.marks, "1 to 2").size() == 1);
    CHECK(shuttles(leaving) == 0);
    CHECK(says(leaving.marks, "arrows show the way"));
    const SlicePicture periodic = slice_of(shuttle(WeftMode::periodic), block, {.view = View::weft_slice});
    CHECK(shuttles(periodic) == 0);
    CHECK_FALSE(says(periodic.marks, "arrows show the way"));
    const SlicePicture entering =
        slice_of(shuttle(WeftMode::wraparound), block, {.view = View::weft_slice, .line = 1});
    CHECK(shuttles(entering) == 0);

    const Block wider = block_of({1}, {2, 2}, {"P0 T0 P1", "P1 T0 P0"});
    CHECK(shuttles(slice_of(shuttle(WeftMode::periodic), wider, {.view = View::weft_slice})) == 1);

    // A pick that comes in and leaves at the same end: both ways run clear of its number and of the dots.
    const Block tall =
        block_of({4, 4, 4}, {2}, {"T0 P0 T1 T2 P1 T3", "T0 T1 P0 T2 T3 P1", "T0 P0 T1 T2 P1 T3"});
    Design four = shuttle(WeftMode::wraparound);
    four.weft.feeders.resize(4, four.weft.feeders[0]);
    four.weft.feeder_order = {{0}, {1}, {2}, {3}};
    const SlicePicture between = slice_of(four, tall, {.view = View::weft_slice, .line = 1});
    CHECK(std::ranges::count_if(between.marks, is_stub) == 8);
    CHECK(places_of(between.marks, "6 from 2").size() == 1);
    CHECK(places_of(between.marks, "6 to 10").size() == 1);
    check_stubs(between);
}
