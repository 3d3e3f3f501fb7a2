#include <studio/viewport/block_faces.hpp>
#include <studio/viewport/camera.hpp>
#include <studio/viewport/view_history.hpp>

#include <weave/picture/tube_camera.hpp>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <cmath>

using namespace weave;
using namespace weave::studio;

namespace {

constexpr PictureSize size{800, 600};
const Box box{{-1, 2, -3}, {11, 22, 4}};

Camera fitted(StandardView view, bool perspective = false) {
    Camera camera;
    camera.perspective = perspective;
    camera.turn_to(view);
    camera.fit(box, size);
    return camera;
}

}  // namespace

TEST_CASE("orbiting keeps the distance and never turns the cloth upside down") {
    for (const bool perspective : {false, true}) {
        Camera camera = fitted(StandardView::corner, perspective);
        const Vec3 eye = camera.centre - camera.away() * camera.distance();
        camera.orbit(123, -31);
        const Vec3 after = camera.centre - camera.away() * camera.distance();
        CHECK((after - camera.centre).norm() == Approx((eye - camera.centre).norm()));
        CHECK(camera.to_camera(camera.centre).head<2>().norm() < 1e-9);
        camera.orbit(0, 500);
        CHECK(camera.elevation_deg == 90);
        CHECK(camera.up().z() >= -1e-12);
        camera.orbit(0, -500);
        CHECK(camera.elevation_deg == -90);
        CHECK(camera.up().z() >= -1e-12);
    }
}

TEST_CASE("what the mouse drags follows it: the near side of the cloth goes with the hand") {
    Camera camera = fitted(StandardView::weft_side);
    const Vec3 near(box.low.x(), 12, 0);  // on the side of pick 1, where the viewer stands
    const Projected before = camera.project(near, size);
    camera.orbit(20, 0);
    CHECK(camera.project(near, size).x > before.x + 10);
    camera = fitted(StandardView::weft_side);
    camera.orbit(0, 20);
    CHECK(camera.project(near, size).y > camera.project(camera.centre, size).y + 10);
}

TEST_CASE(
    "no view mirrors the cloth: end 1 is left and pick 1 at the bottom of the face, end 1 right of the "
    "back") {
    const Vec3 first(0, 3, 0), last_end(0, 20, 0), last_pick(10, 3, 0), higher(0, 3, 3);
    for (const bool perspective : {false, true}) {
        const auto at = [&](StandardView view, const Vec3& place) {
            return fitted(view, perspective).project(place, size);
        };
        CHECK(at(StandardView::face, last_end).x > at(StandardView::face, first).x + 100);
        CHECK(at(StandardView::face, last_pick).y < at(StandardView::face, first).y - 100);
        CHECK(at(StandardView::back, last_end).x < at(StandardView::back, first).x - 100);
        CHECK(at(StandardView::back, last_pick).y < at(StandardView::back, first).y - 100);
        CHECK(at(StandardView::warp_side, last_pick).x > at(StandardView::warp_side, first).x + 100);
        CHECK(at(StandardView::weft_side, last_end).x > at(StandardView::weft_side, first).x + 100);
        for (const StandardView view : {StandardView::warp_side, StandardView::weft_side,
                                        StandardView::corner, StandardView::opposite_corner})
            CHECK(at(view, higher).y < at(view, first).y - 10);
        for (std::size_t k = 0; k < standard_views; ++k) {
            const auto view = static_cast<StandardView>(k);
            const Camera camera = fitted(view, perspective);
            // Left-handed, as the cloth's axes are: so its turn is a turn and no mirror.
            CHECK(camera.right().cross(camera.up()).dot(camera.away()) == Approx(1));
            CHECK(view_of(camera) == view);
        }
    }
}

TEST_CASE("the camera sees places where pictures of relaxed cloth have them") {
    const TubeCamera pictures(32, 38);
    Camera camera;
    const Vec3 place(3, -2, 5);
    const Vec3 seen = pictures.turned(place),
               own = {place.dot(camera.right()), place.dot(camera.up()), place.dot(camera.away())};
    CHECK((seen - own).norm() < 1e-12);
}

TEST_CASE("all of the box is in view after a fit, and fills it") {
    for (const bool perspective : {false, true}) {
        for (std::size_t k = 0; k < standard_views; ++k) {
            const Camera camera = fitted(static_cast<StandardView>(k), perspective);
            double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
            for (const Vec3& corner : box.corners()) {
                const Projected at = camera.project(corner, size);
                left = std::min(left, at.x);
                right = std::max(right, at.x);
                top = std::min(top, at.y);
                bottom = std::max(bottom, at.y);
            }
            INFO("view " << k << (perspective ? ", perspective" : ""));
            CHECK((left > 0 && right < size.width && top > 0 && bottom < size.height));
            CHECK(std::max((right - left) / size.width, (bottom - top) / size.height) > 0.8);
        }
    }
}

TEST_CASE("a ray goes through the place that is seen at its pixel") {
    for (const bool perspective : {false, true}) {
        const Camera camera = fitted(StandardView::corner, perspective);
        const Vec3 place(4, 9, 1);
        const Projected at = camera.project(place, size);
        const Ray ray = camera.ray(at.x, at.y, size);
        const Vec3 way = place - ray.origin;
        CHECK((way - way.dot(ray.way) * ray.way).norm() < 1e-6);
        CHECK(way.dot(ray.way) > 0);
    }
}

TEST_CASE("zooming keeps what lies under the cursor, panning follows it") {
    Camera camera = fitted(StandardView::corner);
    const Vec3 place = camera.centre + camera.right() * 2 - camera.up();
    const Projected at = camera.project(place, size);
    camera.zoom_at(at.x, at.y, 2.5, size);
    CHECK(camera.project(place, size).x == Approx(at.x));
    CHECK(camera.project(place, size).y == Approx(at.y));
    CHECK(camera.scale(size) == Approx(2.5 * fitted(StandardView::corner).scale(size)));
    camera.pan(30, -12, size);
    CHECK(camera.project(place, size).x == Approx(at.x + 30));
    CHECK(camera.project(place, size).y == Approx(at.y - 12));
}

TEST_CASE("a view comes back from JSON as it was, and nonsense changes nothing") {
    Camera camera = fitted(StandardView::opposite_corner, true);
    camera.orbit(17.25, 3.5);
    Camera read;
    REQUIRE(read.from_json(parse_json(camera.to_json().dump()).value()));
    CHECK(read == camera);
    for (const char* text :
         {"[]", "{}",
          R"({"azimuth_deg":0,"elevation_deg":91,"centre_mm":[0,0,0],"height_mm":1,"perspective":true})",
          R"({"azimuth_deg":0,"elevation_deg":9,"centre_mm":[0,0],"height_mm":1,"perspective":true})",
          R"({"azimuth_deg":0,"elevation_deg":9,"centre_mm":[0,0,1e99],"height_mm":1,"perspective":true})",
          R"({"azimuth_deg":0,"elevation_deg":9,"centre_mm":[0,0,0],"height_mm":0,"perspective":true})",
          R"({"azimuth_deg":0,"elevation_deg":9,"centre_mm":[0,0,0],"height_mm":1,"perspective":1})"}) {
        INFO(text);
        CHECK_FALSE(read.from_json(parse_json(text).value()));
        CHECK(read == camera);
    }
}

TEST_CASE("a view between two goes the shorter way round") {
    Camera from, to;
    from.azimuth_deg = 170;
    to.azimuth_deg = -170;
    CHECK(std::abs(between(from, to, 0.5).azimuth_deg) == Approx(180));
    CHECK(between(from, to, 1) == to);
}

TEST_CASE("the history of views goes back and on, and forgets what was gone back from") {
    ViewHistory history;
    Camera a, b, c;
    b.azimuth_deg = 1;
    c.azimuth_deg = 2;
    history.note(a);
    history.note(a);
    CHECK_FALSE(history.can_go_back());
    history.note(b);
    REQUIRE(history.can_go_back());
    CHECK(history.back() == a);
    REQUIRE(history.can_go_on());
    CHECK(history.on() == b);
    CHECK(history.back() == a);
    history.note(c);
    CHECK_FALSE(history.can_go_on());
    CHECK(history.back() == a);
}

TEST_CASE("a ray enters the box by the face that is seen there") {
    const Box cube{{0, 0, 0}, {1, 1, 1}};
    for (const Face face : all_faces) {
        const Camera camera = facing(face, Camera{});
        CHECK(camera.away().dot(normal_of(face)) == Approx(-1));
        Camera centred = camera;
        centred.fit(cube, size);
        CHECK(is_seen(cube, face, centred));
        const auto met = face_at(cube, centred.ray(size.width / 2, size.height / 2, size));
        REQUIRE(met);
        CHECK(*met == face);
        CHECK_FALSE(face_at(cube, centred.ray(2, 2, size)));
    }
}
