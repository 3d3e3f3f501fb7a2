#include <weave/design/yarns.hpp>
#include <weave/picture/cloth_view.hpp>
#include <weave/picture/colour_map.hpp>
#include <weave/picture/look.hpp>
#include <weave/picture/tube_render.hpp>
#include <weave/picture/tube_shade.hpp>

#include <picture/pictures.hpp>
#include <support/demo_yarns.hpp>
#include <support/random.hpp>
#include <support/straight_yarn.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

constexpr Colour red{0xe0, 0x20, 0x20}, blue{0x20, 0x40, 0xe0};

ClothView view_of(const ClothWords& words) {
    auto view = parse_cloth_view(words);
    if (!view) FAIL(view.error().text());
    return *view;
}

/// A red warp along x over a blue weft along y, both 10 mm long, crossing in the middle.
Yarns cross(double warp_height = 1) {
    Yarns yarns;
    yarns.size_mm = {10, 10};
    yarns.yarns = {straight_yarn(System::weft, 0, {5, 0, 0}, {5, 10, 0}, blue),
                   straight_yarn(System::warp, 0, {0, 5, warp_height}, {10, 5, warp_height}, red)};
    return yarns;
}

/// A scene and its picture, in which places of the cloth can be looked up.
struct Shot {
    Shot(const Yarns& yarns, const ClothView& view, std::size_t side = 300)
        : camera(view.azimuth_deg, view.elevation_deg), width(side) {
        auto made = make_scene(yarns, view, camera);
        if (!made) FAIL(made.error().text());
        const auto pixels_wide = static_cast<double>(side);
        camera.fit(box_of(*made, camera), {10, 10, pixels_wide - 20, pixels_wide - 20});
        scene = std::move(made).value();
        pixels = render(scene, camera, side, side);
    }
    [[nodiscard]] Colour at(const Vec3& place) const {
        const Rectangle box = camera.on_screen(camera.box_of(camera.to_camera(place), 1e-9));
        const auto x = static_cast<std::size_t>(box.x), y = static_cast<std::size_t>(box.y);
        REQUIRE((x < width && y < width));
        const std::uint32_t pixel = pixels[y * width + x];
        return {static_cast<std::uint8_t>(pixel >> 16), static_cast<std::uint8_t>(pixel >> 8),
                static_cast<std::uint8_t>(pixel)};
    }
    TubeCamera camera;
    TubeScene scene;
    std::size_t width;
    std::vector<std::uint32_t> pixels;
};

bool is_reddish(Colour colour) {
    return colour.red > colour.blue + 40;
}
bool is_bluish(Colour colour) {
    return colour.blue > colour.red + 40;
}
constexpr Colour white{255, 255, 255};

std::string drawn(const Yarns& yarns, const ClothView& view) {
    auto file = draw_cloth(yarns, view);
    if (!file) FAIL(file.error().text());
    return *file;
}

Error refusal(const Yarns& yarns, const ClothView& view) {
    auto file = draw_cloth(yarns, view);
    REQUIRE_FALSE(file);
    return file.error();
}

}  // namespace

TEST_CASE("where two yarns cross the nearer one is seen, from every side") {
    for (const bool perspective : {false, true}) {
        const Vec3 crossing(5, 5, 0.5);
        const auto seen = [&](const Yarns& yarns, const char* side) {
            return Shot(yarns, view_of({.side = side, .perspective = perspective})).at(crossing);
        };
        for (const char* side : {"top", "corner", "20,60", "-130,45"}) {
            INFO(side << (perspective ? ", perspective" : ""));
            CHECK(is_reddish(seen(cross(1), side)));
            CHECK(is_bluish(seen(cross(-1), side)));
        }
        CHECK(is_bluish(seen(cross(1), "bottom")));
        CHECK(is_reddish(seen(cross(-1), "bottom")));
    }
}

TEST_CASE("the named sides show the cloth as its face and back are drawn") {
    // A marker at the first pick and first end, one at the last end.
    Yarns yarns;
    yarns.yarns = {straight_yarn(System::weft, 0, {0, 0, 0}, {0, 1, 0}, red),
                   straight_yarn(System::weft, 0, {0, 9, 0}, {0, 10, 0}, blue),
                   straight_yarn(System::warp, 0, {9, 0, 0}, {10, 0, 0}, blue)};
    const auto screen = [&](const char* side, const Vec3& place) {
        const Shot shot(yarns, view_of({.side = side}));
        const Rectangle box = shot.camera.on_screen(shot.camera.box_of(shot.camera.to_camera(place), 1e-9));
        return Point{box.x, box.y};
    };
    const Vec3 first(0, 0, 0), last_end(0, 10, 0), last_pick(10, 0, 0);
    CHECK(screen("top", last_end).x > screen("top", first).x + 100);
    CHECK(screen("top", last_pick).y < screen("top", first).y - 100);
    CHECK(screen("bottom", last_end).x < screen("bottom", first).x - 100);
    CHECK(screen("bottom", last_pick).y < screen("bottom", first).y - 100);
    CHECK(screen("front", last_end).x > screen("front", first).x + 100);
    CHECK(screen("back", last_end).x < screen("back", first).x - 100);
    CHECK(screen("right", last_pick).x > screen("right", first).x + 100);
    CHECK(screen("left", last_pick).x < screen("left", first).x - 100);
    CHECK(is_reddish(Shot(yarns, view_of({.side = "top"})).at({0, 0.5, 0})));
    CHECK(is_bluish(Shot(yarns, view_of({.side = "top"})).at({0, 9.5, 0})));
}

TEST_CASE("a cut shows flat discs in a lighter colour, and nothing in front of them") {
    const Shot front(cross(), view_of({.side = "front", .cut = "x=2"}));
    const Colour disc = front.at({2, 5, 1});
    CHECK(is_reddish(disc));
    CHECK(disc.green > red.green + 60);
    CHECK(disc.blue > red.blue + 60);
    CHECK(front.at({2, 5.2, 1.1}) == disc);  // flat: no shading
    CHECK(front.at({2, 5, 1.46}) != disc);   // its rim
    CHECK(is_bluish(front.at({5, 2, 0})));   // the weft behind
    // Seen from the back the same plane takes the other half, with the weft.
    const Shot back(cross(), view_of({.side = "back", .cut = "x=2"}));
    CHECK(back.at({2, 5, 1}) == disc);
    CHECK(back.scene.pieces.size() < front.scene.pieces.size());
    // Through the weft along its axis: a flat strip.
    const Shot along(cross(), view_of({.side = "front", .cut = "x=5"}));
    CHECK(along.at({5, 2, 0}) == along.at({5, 8, 0.2}));
    CHECK(is_bluish(along.at({5, 2, 0})));
    // An oblique plane by point and normal keeps what lies behind it.
    const Shot oblique(cross(), view_of({.side = "top", .cut = "5,2,0:0,-1,0"}));
    CHECK(is_bluish(oblique.at({5, 2.5, 0})));
    CHECK(oblique.scene.size.y() == Approx(8));
}

TEST_CASE("a cut that passes the cloth by is known to cut nothing") {
    const auto is_cut = [](const char* side, const char* cut) {
        return Shot(cross(), view_of({.side = side, .cut = cut})).scene.is_cut_through;
    };
    CHECK(is_cut("top", "z=1.499"));  // the warp, on top, lies 1 mm high and has a radius of half a millimetre
    CHECK_FALSE(is_cut("top", "z=1.501"));
    CHECK(is_cut("front", "x=0.001"));  // it begins, flat, at 0
    CHECK_FALSE(is_cut("front", "x=-0.001"));
    CHECK_FALSE(is_cut("top", ""));
}

TEST_CASE("yarns end flat at the rim of the piece, whatever lies in their last pieces") {
    Yarns yarns = plain_weave();
    const Shot shot(yarns, view_of({.side = "top"}), 600);
    const double end = yarns.size_mm[0];
    CHECK(shot.scene.size.x() == Approx(end + 0.12).epsilon(0.001));  // and half a weft
    CHECK(shot.at({end - 0.02, 0.5, 0.2}) != white);
    CHECK(shot.at({end + 0.08, 0.5, 0}) == white);  // within a radius of the end
}

TEST_CASE("yarns are drawn in their own colours, or the paper's where nobody chose") {
    const Shot own(cross(), view_of({.side = "top"}));
    CHECK(own.scene.colours == std::vector<Colour>{blue, red});
    Yarns plain = cross();
    plain.yarns[0].colour = default_weft().yarns[0].colour;
    plain.yarns[1].colour = default_warp().yarns[0].colour;
    CHECK(Shot(plain, view_of({})).scene.colours == std::vector<Colour>{paper_weft, paper_warp});
}

TEST_CASE("strain, contact, movement and height colour the yarns between the ends of the bar") {
    Yarns yarns = cross();
    yarns.yarns[1].planned = {{0, 5, 1}, {10, 5, 4}};
    const Shot strain(yarns, view_of({.side = "top", .colour = "strain"}));
    CHECK((strain.scene.low == 0 && strain.scene.high == Approx(10)));
    CHECK(strain.at({0.3, 5, 1}).green < 60);                                // violet: nothing
    CHECK(strain.at({9.7, 5, 1}).green > strain.at({9.7, 5, 1}).blue + 60);  // yellow: most
    const Shot contact(yarns, view_of({.side = "top", .colour = "contact"}));
    CHECK((contact.scene.low == 0 && contact.scene.high == Approx(2)));
    const Shot moved(yarns, view_of({.side = "top", .colour = "moved"}));
    CHECK((moved.scene.low == 0 && moved.scene.high == Approx(3)));
    CHECK(moved.at({9.7, 5, 1}).green > moved.at({9.7, 5, 1}).blue + 60);
    CHECK(moved.at({5, 1, 0}).green < 60);
    yarns.yarns[0].contact_N = yarns.yarns[1].contact_N = {0, 0};
    CHECK_NOTHROW(drawn(yarns, view_of({.colour = "contact"})));
    yarns.yarns[0].spline.control = {{5, 0, -2}, {5, 10, -2}};
    const Shot height(yarns, view_of({.side = "top", .colour = "height"}));
    CHECK((height.scene.low == -2 && height.scene.high == 1));
    CHECK(height.at({5, 1, -2}).green < 60);
    CHECK(height.at({9.7, 5, 1}).green > height.at({9.7, 5, 1}).blue + 60);
}

TEST_CASE("the strain of what is held as planned does not stretch the scale") {
    Yarns yarns = cross();
    SimulatedYarn& warp = yarns.yarns[1];
    warp.spline.control.clear();
    warp.planned.clear();
    warp.strain = {1.3, 1.3, 1.2, 0.02, 0.03, 0.05, 0.05};
    for (std::size_t i = 0; i < warp.strain.size(); ++i) {
        const double x = 10.0 / 6 * static_cast<double>(i);
        warp.spline.control.emplace_back(x, 5, 1);
        warp.planned.emplace_back(x, 5, i < 2 ? 1 : 1.5);  // the first two are held
    }
    warp.contact_N.assign(warp.strain.size(), 0);
    const Shot shot(yarns, view_of({.side = "top", .colour = "strain"}));
    CHECK((shot.scene.low == Approx(2) && shot.scene.high == Approx(5)));
    for (SimulatedYarn& yarn : yarns.yarns) yarn.planned = yarn.spline.control;  // all held: all counts
    CHECK(Shot(yarns, view_of({.side = "top", .colour = "strain"})).scene.high > 100);
}

TEST_CASE("a picture says whether its yarns are as planned, at rest or not") {
    Yarns yarns = cross();
    const auto picture = [&](const Json& report) {
        yarns.report = report;
        return drawn(yarns, view_of({}));
    };
    const std::string relaxed = picture({{"converged", true}, {"iterations", 7}}),
                      moving = picture({{"converged", false}, {"iterations", 7}}),
                      planned = picture({{"converged", false}, {"iterations", 0}});
    CHECK(picture(Json::object()) == relaxed);
    CHECK((moving != relaxed && planned != relaxed && planned != moving));
}

TEST_CASE("the colour map is evenly lighter from end to end") {
    CHECK(map_colour(-1) == Colour{0x44, 0x01, 0x54});
    CHECK(map_colour(2) == Colour{0xfd, 0xe7, 0x25});
    double before = -1;
    for (int k = 0; k <= 100; ++k) {
        const Colour colour = map_colour(k / 100.0);
        const Light light = to_light(colour);
        const double lightness = std::cbrt(0.2126 * light[0] + 0.7152 * light[1] + 0.0722 * light[2]);
        if (k > 0) {
            CHECK(lightness - before > 0.002);
            CHECK(lightness - before < 0.011);
        }
        before = lightness;
    }
}

TEST_CASE("light goes to pixels and back") {
    for (int k = 0; k < 256; ++k) {
        const auto value = static_cast<std::uint8_t>(k);
        CHECK(to_pixel(to_light({value, value, value})) == pixel_of({value, value, value}));
    }
}

TEST_CASE("periodic pieces can stand side by side without a seam") {
    const Yarns yarns = plain_weave();
    const Shot one(yarns, view_of({.side = "top"}), 400);
    const Shot many(yarns, view_of({.side = "top", .repeat = "2x3"}), 400);
    CHECK(many.scene.pieces.size() == 6 * one.scene.pieces.size());
    CHECK(many.scene.size.x() == Approx(one.scene.size.x() + 4));
    CHECK(many.scene.size.y() == Approx(one.scene.size.y() + 8));
    // About the seam a warp looks as it does a wave before.
    for (const double x : {3.9, 4.0, 4.1, 4.2}) {
        const Colour here = many.at({x, 0.5, 0}), before = many.at({x - 1, 0.5, 0});
        INFO(x);
        CHECK(is_reddish(here));
        CHECK(std::abs(here.red - before.red) < 12);
    }
    Yarns bounded = yarns;
    bounded.is_periodic = {true, false};
    const Error error = refusal(bounded, view_of({.repeat = "1x2"}));
    CHECK(error.code == ErrorCode::usage);
    CHECK(error.message.find("picks (y)") != std::string::npos);
    CHECK_NOTHROW(drawn(bounded, view_of({.repeat = "2x1", .size = "400x300"})));
}

TEST_CASE("hollows are darker than open places, and straight yarn does not shade itself") {
    const Yarns alone = [] {
        Yarns yarns = cross();
        yarns.yarns.pop_back();
        return yarns;
    }();
    const Shot open(alone, view_of({.side = "top"}));
    const auto hidden = [&](const Shot& shot, const Vec3& place) {
        return Occlusion(shot.scene).hidden(shot.camera.to_camera(place), shot.camera.turned({0, 0, 1}));
    };
    CHECK(hidden(open, {5, 4, 0.5}) == 0);
    const Shot under(cross(1.2), view_of({.side = "top"}));
    CHECK(hidden(under, {5, 4.3, 0.5}) > 0.3F);
    CHECK(hidden(under, {5, 4.3, 0.5}) > 2 * hidden(under, {5, 3, 0.5}));
    CHECK(hidden(under, {5, 1, 0.5}) < 0.02F);
}

TEST_CASE("a ray meets a piece of yarn where the algebra says, beyond its ends too") {
    for_all(
        [](Random& random) {
            const auto number = [&] { return static_cast<double>(random.between(0, 2000)) / 1000 - 1; };
            TubePiece piece;
            piece.from = {number(), number(), number()};
            piece.to = random.between(0, 9) == 0 ? piece.from : Vec3(number(), number(), number());
            piece.radius = 0.05 + 0.3 * std::abs(number());
            Ray ray{{number() * 3, number() * 3, -5}, {0, 0, 1}};
            if (random.between(0, 9) == 0 && (piece.to - piece.from).norm() > 0) {
                ray.way = (piece.to - piece.from).normalized();  // along the axis
                ray.origin = piece.from - 4 * ray.way + Vec3(number(), number(), number()) * 0.3;
            } else {
                const Vec3 aim(number(), number(), number());
                ray.way = (aim - ray.origin).normalized();
            }
            const Stretch stretch = within(piece, ray);
            // Along the ray the distance from the axis has one least place: go through it in small steps.
            double first = 1e9, last = -1e9;
            constexpr double step = 0.004;
            for (double t = 0; t < 14; t += step) {
                const Vec3 place = ray.origin + t * ray.way;
                if ((place - nearest_on_axis(piece, place)).norm() >= piece.radius) continue;
                first = std::min(first, t);
                last = std::max(last, t);
            }
            if (last < first) {
                CHECK((stretch.is_empty() || stretch.to - stretch.from < 2 * step));
            } else {
                CHECK(stretch.from == Approx(first).margin(1.01 * step));
                CHECK(stretch.to == Approx(last).margin(1.01 * step));
            }
        },
        std::min<std::size_t>(property_cases(), 2000));
}

TEST_CASE("pictures have the size that was asked for and are the same every time") {
    const Yarns yarns = interlock({1, 2, 3}, {200, 100, 0});
    const ClothView view = view_of({.cut = "y=1.1", .colour = "strain", .repeat = "2x1", .size = "640x480"});
    const std::string first = drawn(yarns, view);
    const Pixels pixels = read_pixels(first);
    CHECK((pixels.width == 640 && pixels.height == 480));
    CHECK(pixels.at({1, 1}) == white);
    CHECK((first == drawn(yarns, view)));
    Yarns named = yarns;
    named.title = std::string(200, 'W');
    const Pixels small =
        read_pixels(drawn(named, view_of({.side = "-130.55,45.55", .colour = "moved", .size = "400x300"})));
    CHECK((small.width == 400 && small.height == 300));
    const Pixels usual = read_pixels(drawn(yarns, {}));
    CHECK((usual.width == 1600 && usual.height == 1200));
}

TEST_CASE("the whole cloth lies in the picture from any side, and fills it") {
    for_all(
        [](Random& random) {
            ClothView view;
            view.azimuth_deg = static_cast<double>(random.between(0, 720)) - 360;
            view.elevation_deg = static_cast<double>(random.between(0, 180)) - 90;
            view.perspective = random.coin();
            INFO(view.azimuth_deg << ", " << view.elevation_deg);
            const std::size_t size = 80;
            const Shot shot(plain_weave(), view, size);
            const auto is_drawn = [&](std::size_t x, std::size_t y) {
                return shot.pixels[y * size + x] != 0xffffff;
            };
            std::size_t low_x = size, high_x = 0, low_y = size, high_y = 0;
            for (std::size_t y = 0; y < size; ++y) {
                for (std::size_t x = 0; x < size; ++x) {
                    if (!is_drawn(x, y)) continue;
                    low_x = std::min(low_x, x);
                    high_x = std::max(high_x, x);
                    low_y = std::min(low_y, y);
                    high_y = std::max(high_y, y);
                }
            }
            CHECK((low_x >= 9 && high_x <= size - 10 && low_y >= 9 && high_y <= size - 10));
            CHECK(std::max(high_x - low_x, high_y - low_y) > size - 30);
        },
        12);
}

TEST_CASE("what cannot be drawn is refused with its reason") {
    CHECK(refusal({}, {}).message == "there is no yarn to draw");
    ClothView svg;
    svg.format = PictureFormat::svg;
    CHECK(refusal(cross(), svg).code == ErrorCode::usage);
    CHECK(refusal(cross(), view_of({.side = "top", .cut = "z=-9"})).message.find("leaves nothing") !=
          std::string::npos);
    Yarns wild = plain_weave();
    for (Vec3& place : wild.yarns[0].spline.control) place *= 1e8;
    CHECK_NOTHROW(drawn(wild, view_of({.size = "400x300"})));
    CHECK(refusal(plain_weave(), view_of({.repeat = "100x100"})).message.find("pieces") != std::string::npos);
    Yarns lump = cross();
    SimulatedYarn& thick = lump.yarns[0];
    for (int k = 0; k < 20'000; ++k) thick.spline.control.push_back({1e-6 * k, 0, 0});
    thick.planned = thick.spline.control;
    thick.strain.resize(thick.planned.size());
    thick.contact_N.resize(thick.planned.size());
    thick.radius_mm = 50;
    CHECK(refusal(lump, {}).message.find("so thick") != std::string::npos);
    Yarns uneven = cross();
    uneven.yarns[0].strain.clear();
    CHECK(refusal(uneven, {}).code == ErrorCode::invalid);
}

TEST_CASE("words for pictures of relaxed cloth are read, or refused as usage") {
    const ClothView view = view_of({.side = "-30,12.5",
                                    .cut = "z=0.4",
                                    .colour = "moved",
                                    .repeat = "3x4",
                                    .size = "800x600",
                                    .perspective = true});
    CHECK((view.azimuth_deg == -30 && view.elevation_deg == 12.5));
    REQUIRE(view.cut);
    CHECK((view.cut->point == Vec3(0, 0, 0.4) && view.cut->normal == Vec3(0, 0, 1)));
    CHECK(view.cut->words == "z = 0.4 mm");
    CHECK((view.colour == ClothColour::moved && view.repeat == std::array<std::size_t, 2>{3, 4}));
    CHECK((view.width == 800 && view.height == 600 && view.perspective));
    CHECK(view_of({.side = "bottom", .cut = "z=0.4"}).cut->normal == Vec3(0, 0, -1));
    CHECK(view_of({.cut = "1,2,3:0,0,-2"}).cut->point == Vec3(1, 2, 3));
    const std::vector<ClothWords> wrong{
        {.side = "above"},    {.side = "30"},        {.side = "30,91"},      {.side = "nan,0"},
        {.side = "1,2,3"},    {.cut = "w=1"},        {.cut = "x="},          {.cut = "x=1,2"},
        {.cut = "x"},         {.cut = "1,2,3"},      {.cut = "1,2,3:0,0,0"}, {.cut = "1,2:0,0,1"},
        {.cut = "x=inf"},     {.colour = "heat"},    {.repeat = "3"},        {.repeat = "0x1"},
        {.repeat = "1x101"},  {.repeat = "1.5x2"},   {.repeat = "-1x2"},     {.size = "0x0"},
        {.size = "9000x600"}, {.size = "800x600x1"}, {.size = "800"},        {.colour = "\xff"}};
    for (const ClothWords& words : wrong) {
        INFO(words.side << words.cut << words.colour << words.repeat << words.size);
        const auto read = parse_cloth_view(words);
        REQUIRE_FALSE(read);
        CHECK(read.error().code == ErrorCode::usage);
    }
}
