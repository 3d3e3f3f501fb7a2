// Pieces of a scene around a place.

#include "scenes.hpp"

#include <weave/sim/neighbourhood.hpp>

#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

SimScene large_weave(Random& random) {
    SimScene scene = plain_weave({.count = 14, .points_a_crossing = 3, .swing = 0.8});
    for (SimYarn& yarn : scene.yarns) shake(random, yarn, 0.01);
    return scene;
}

Vec3 some_place(Random& random, const SimScene& scene) {
    return {uniform(random, 0, scene.period_mm[0]), uniform(random, 0, scene.period_mm[1]), 0};
}

}  // namespace

TEST_CASE("what moves in a neighbourhood is pulled as it is in the whole, at the seam of the repeat as well") {
    std::size_t cut = 0;
    weave::testing::for_all(
        [&](Random& random) {
            const SimScene scene = large_weave(random);
            const Neighbourhood part = neighbourhood(scene, some_place(random, scene), 1.2);
            Bench whole(scene), piece(part.scene);
            whole.evaluate();
            piece.evaluate();
            CHECK(piece.fabric.points() < whole.fabric.points() / 2);
            std::size_t moving = 0;
            for (std::size_t k = 0; k < part.pieces.size(); ++k) {
                const auto& [yarn, first, moved] = part.pieces[k];
                const SimYarn& cut_yarn = part.scene.yarns[k];
                cut += cut_yarn.control.size() < scene.yarns[yarn].control.size() ? 1 : 0;
                for (std::size_t i = 0; i < cut_yarn.control.size(); ++i) {
                    if (cut_yarn.frozen[i] != 0) continue;
                    ++moving;
                    const std::size_t at = (first + i) % scene.yarns[yarn].control.size();
                    const Vec3 here = load(&piece.gradient[piece.at(k, i)]), there = load(&whole.gradient[whole.at(yarn, at)]);
                    CHECK((here - there).norm() <= 1e-9 * (1 + there.norm()));
                }
            }
            CHECK(moving > 20);
        },
        10);
    CHECK(cut > 10);
}

TEST_CASE("a neighbourhood is put back where it came from, and what moved in it moves there alone") {
    weave::testing::for_all(
        [&](Random& random) {
            const SimScene scene = large_weave(random);
            Neighbourhood part = neighbourhood(scene, some_place(random, scene), 1.2);
            SimScene same = scene;
            put_back(part, same);
            for (std::size_t y = 0; y < scene.yarns.size(); ++y) {
                for (std::size_t i = 0; i < scene.yarns[y].control.size(); ++i)
                    REQUIRE((same.yarns[y].control[i] - scene.yarns[y].control[i]).norm() < 1e-12);
            }
            std::size_t moved = 0;
            for (SimYarn& yarn : part.scene.yarns) {
                for (std::size_t i = 0; i < yarn.control.size(); ++i) {
                    yarn.control[i] += Vec3(0, 0, 1);
                    moved += yarn.frozen[i] == 0 ? 1 : 0;
                }
            }
            put_back(part, same);
            std::size_t found = 0;
            for (std::size_t y = 0; y < scene.yarns.size(); ++y) {
                for (std::size_t i = 0; i < scene.yarns[y].control.size(); ++i)
                    found += (same.yarns[y].control[i] - scene.yarns[y].control[i] - Vec3(0, 0, 1)).norm() < 1e-12 ? 1 : 0;
            }
            CHECK(found == moved);
        },
        10);
}

TEST_CASE("in a small scene a neighbourhood has whole yarns, frozen far off") {
    const SimScene scene = plain_weave({.count = 2, .points_a_crossing = 4, .swing = 0.8});
    const Neighbourhood part = neighbourhood(scene, {0, 0, 0}, 0.3);
    CHECK(part.scene.is_periodic == scene.is_periodic);
    for (std::size_t k = 0; k < part.pieces.size(); ++k)
        CHECK(part.scene.yarns[k].control == scene.yarns[part.pieces[k].yarn].control);
}
