#include "differences.hpp"
#include "scenes.hpp"

#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

SimYarn only(SimYarn yarn, bool stretches, bool bends) {
    if (!stretches) yarn.stretch_N = 0;
    if (!bends) yarn.bending_N_mm2 = 0;
    return yarn;
}

/// One crooked yarn with uneven points.
SimScene crooked(Random& random, const SimYarn& kind, bool is_periodic) {
    SimScene scene;
    scene.is_periodic = {is_periodic, false};
    scene.period_mm = {2, 0};
    const std::size_t points = random.between(is_periodic ? 1 : 3, 7);
    SimYarn yarn = laid(kind, {0, 0, 0}, {2, 0, 0}, points, is_periodic);
    yarn.rest_mm = uniform(random, 1.5, 2.5);
    yarn.turns = {is_periodic ? 1 : 0, 0};
    shake(random, yarn, 0.4 / static_cast<double>(points));
    scene.yarns = {yarn};
    return scene;
}

}  // namespace

TEST_CASE("stretch and bending pull as their energies say, and curve as their pulls say") {
    weave::testing::for_all(
        [](Random& random) {
            SimYarn kind = only(usual_yarn(0.01), random.coin(), true);
            kind.is_fed = random.coin();
            if (random.between(0, 2) == 0) kind = only(kind, true, false), kind.stretch_N = 40;
            SimScene scene = crooked(random, kind, random.coin());
            INFO("fed " << kind.is_fed << ", EA " << kind.stretch_N << ", EI " << kind.bending_N_mm2
                        << ", points " << scene.yarns[0].control.size() << ", periodic "
                        << scene.yarns[0].is_periodic);
            if (scene.yarns[0].control.size() < 2) return;  // straight whatever its one point does
            CHECK(gradient_error(scene, {.elastic = true, .contact = false}) < 1e-6);
            check_matrices(scene);
        },
        60);
}

TEST_CASE("yarns that give way pull as their energy says, and curve as their pulls say") {
    std::size_t given = 0;
    weave::testing::for_all(
        [&](Random& random) {
            SimYarn kind = only(usual_yarn(0.01), true, random.coin());
            kind.is_fed = false;
            SimScene scene = crooked(random, kind, random.coin());
            scene.yarns[0].rest_mm = uniform(random, 0.8, 2.5);
            if (scene.yarns[0].control.size() < 2) return;
            Bench firm(scene), bench(scene);
            bench.energy.give_beyond(0.05);
            const double lower = bench.evaluate(), value = firm.evaluate();
            CHECK(lower <= value);
            given += lower < value ? 1 : 0;
            CHECK(gradient_error(bench, {.elastic = true, .contact = false}) < 1e-6);
            check_matrices(bench);
        },
        60);
    CHECK(given > 10);
}

TEST_CASE("contact pulls as its energy says, equal and mixed radii, open ends, frozen points") {
    std::size_t touching = 0;
    weave::testing::for_all(
        [&](Random& random) {
            SimScene scene = heap(random, random.between(2, 4), random.coin() ? 0.12 : 0.04);
            if (random.coin()) {
                for (SimYarn& yarn : scene.yarns) {
                    yarn.frozen.assign(yarn.control.size(), 0);
                    for (std::uint8_t& frozen : yarn.frozen) frozen = random.between(0, 3) == 0;
                }
            }
            Bench bench(scene);
            bench.evaluate({.elastic = false, .contact = true});
            if (greatest(bench.gradient) > 1e-3) {
                CHECK(gradient_error(scene, {.elastic = false, .contact = true}) < 1e-6);
                ++touching;
            }
            CHECK(gradient_error(scene) < 1e-6);
            check_matrices(scene);
        },
        20);
    CHECK(touching > 10);
}

TEST_CASE("contact with periodic images pulls as its energy says") {
    weave::testing::for_all(
        [](Random& random) {
            WeaveShape shape;
            shape.points_a_crossing = random.between(1, 3);
            shape.pitch_mm = uniform(random, 0.3, 0.6);
            shape.swing = 0.7;
            SimScene scene = plain_weave(shape);
            if (random.coin()) scene.yarns.erase(scene.yarns.begin() + 1);
            for (SimYarn& yarn : scene.yarns) shake(random, yarn, 0.02);
            CHECK(gradient_error(scene, {.elastic = false, .contact = true}) < 1e-6);
            check_matrices(scene);
        },
        8);
}

TEST_CASE("a period shorter than the yarns are thick counts every image") {
    weave::testing::for_all(
        [](Random& random) {
            SimScene scene;
            scene.is_periodic = {true, true};
            scene.period_mm = {1.2, 0.1};  // a yarn of 0.24 touches two images on either side
            SimYarn yarn = laid(usual_yarn(), {0, 0, 0}, {1.2, 0, 0}, 5, true);
            yarn.turns = {1, 0};
            shake(random, yarn, 0.02);
            scene.yarns = {yarn};
            CHECK(gradient_error(scene, {.elastic = false, .contact = true}) < 1e-6);
            check_matrices(scene);
        },
        4);
}

TEST_CASE("fields and gravity pull as their energies say, and curve as their pulls say") {
    weave::testing::for_all(
        [](Random& random) {
            SimScene scene = heap(random, 2);
            if (random.coin()) scene.gravity_mm_ms2 = 9.80665e-3;
            for (SimYarn& yarn : scene.yarns) {
                yarn.gram_per_mm = uniform(random, 0, 100);
                yarn.is_fed = random.coin();
            }
            scene.fields.push_back(
                {.centre_mm = {0.1, 0.1, -0.2}, .radius_mm = 0.9, .strength_N_per_mm = uniform(random, -4, 4)});
            if (random.coin())
                scene.fields.push_back(
                    {.centre_mm = {-0.3, 0, 0.3}, .radius_mm = 0.5, .strength_N_per_mm = 6});
            CHECK(gradient_error(scene) < 1e-6);
            check_matrices(scene);
        },
        20);
}

TEST_CASE("the gradient in float is the one in double as far as float goes") {
    weave::testing::for_all(
        [](Random& random) {
            const SimScene scene = heap(random, 4, 0.06);
            Bench<double> fine(scene);
            Bench<float> coarse(scene);
            const double energy = fine.evaluate();
            CHECK(coarse.evaluate() == Approx(energy).epsilon(1e-5));
            const double scale = greatest(fine.gradient);
            for (std::size_t i = 0; i < fine.gradient.size(); ++i)
                CHECK(std::abs(fine.gradient[i] - static_cast<double>(coarse.gradient[i])) < 1e-4 * scale);
        },
        20);
}
