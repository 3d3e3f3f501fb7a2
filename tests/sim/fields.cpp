#include "scenes.hpp"

#include <weave/curve/spline.hpp>
#include <weave/sim/relax.hpp>

#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

/// A yarn held at both ends right through a sphere, a little beside its centre.
SimScene through_a_sphere(std::size_t points, bool is_fed) {
    SimScene scene;
    SimYarn yarn = usual_yarn(0.05);
    yarn.is_fed = is_fed;
    yarn.rest_mm = 4;
    yarn = laid(yarn, {-2, 0, 0.1}, {2, 0, 0.1}, points);
    yarn.frozen.assign(points, 0);
    yarn.frozen.front() = yarn.frozen.back() = 1;
    scene.yarns = {yarn};
    scene.fields = {{.centre_mm = {0, 0, 0}, .radius_mm = 1, .strength_N_per_mm = 2}};
    return scene;
}

}  // namespace

TEST_CASE("a straight yarn through a sphere has the energy of the formula, whatever its points") {
    // Through the middle: twice the integral of K/2 (R - x)^2 over x from 0 to R is K R^3 / 3, with K = strength / R.
    for (const bool is_fed : {false, true}) {
        double coarse = 0;
        for (const std::size_t points : {41, 81, 401}) {
            SimScene scene = through_a_sphere(points, is_fed);
            for (Vec3& point : scene.yarns[0].control) point.z() = 1e-9;
            Bench with(scene);
            scene.fields.clear();
            Bench without(scene);
            const double energy = with.evaluate() - without.evaluate();
            CHECK(energy == Approx(2.0 / 3).epsilon(2e-3));
            if (coarse != 0) CHECK(energy == Approx(coarse).epsilon(2e-3));
            coarse = energy;
        }
    }
}

TEST_CASE("a sphere bends a yarn as far with few points as with many, fed or of fixed length") {
    for (const bool is_fed : {false, true}) {
        double height = 0;
        for (const std::size_t points : {33, 65, 257}) {
            Bench bench(through_a_sphere(points, is_fed));
            const RelaxResult result = relax(bench.energy, bench.state, {.residual = 1e-8, .watch = {}});
            CHECK(result.ending == Ending::converged);
            const double middle = bench.state[bench.at(0, points / 2) + 2];
            CHECK(middle > 0.3);
            if (height != 0) CHECK(middle == Approx(height).epsilon(0.01));
            height = middle;
        }
    }
}

TEST_CASE("a fed yarn that leans against a sphere is as tight inside as the push along it asks") {
    // At rest the force along the yarn is balanced everywhere: no control point is pulled along it, far out or deep in.
    Bench bench(through_a_sphere(129, true));
    relax(bench.energy, bench.state, {.residual = 1e-10, .watch = {}});
    bench.evaluate();
    for (std::size_t i = 1; i + 1 < 129; ++i) {
        const Vec3 along = load(&bench.state[bench.at(0, i + 1)]) - load(&bench.state[bench.at(0, i - 1)]);
        CHECK(std::abs(load(&bench.gradient[bench.at(0, i)]).dot(along.normalized())) < 1e-6);
    }
}

TEST_CASE("yarns that do not feel contact, and yarns without a curve, do no harm") {
    Random random(1);
    SimScene scene = heap(random, 3);
    scene.yarns[0].contact_N_mm2 = 0;
    SimYarn point = usual_yarn(), nothing = usual_yarn(), ring = usual_yarn();
    point.control = {Vec3(0, 0, 0)};
    point.rest_mm = nothing.rest_mm = ring.rest_mm = 1;
    ring.is_periodic = true;
    scene.yarns.insert(scene.yarns.end(), {point, nothing, ring});
    Bench bench(scene);
    const double energy = bench.evaluate();
    CHECK(std::isfinite(energy));
    for (const double number : bench.gradient) CHECK(std::isfinite(number));
    CHECK(bench.fabric.control(bench.state)[3] == point.control);
    CHECK(bench.fabric.control(bench.state)[4].empty());
    const RelaxResult result = relax(bench.energy, bench.state, {.residual = 1e-3, .most_iterations = 20, .watch = {}});
    CHECK(std::isfinite(result.residual));
    CHECK(bench.fabric.control(bench.state)[3] == point.control);

    // The same yarns without the contact of the first: as if it were not there.
    SimScene fewer = scene;
    fewer.yarns.erase(fewer.yarns.begin());
    Bench rest(fewer);
    SimScene alone = scene;
    alone.yarns = {scene.yarns[0]};
    Bench first(alone);
    CHECK(energy == Approx(rest.evaluate() + first.evaluate()));
}
