#include "scenes.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

double size_of(const std::vector<double>& gradient) {
    double sum = 0;
    for (const double number : gradient) sum += number * number;
    return std::sqrt(sum);
}

/// The scene with every place changed, shifts of periodic yarns as they are.
template <class Change>
SimScene changed(SimScene scene, const Change& change) {
    for (SimYarn& yarn : scene.yarns) {
        for (Vec3& point : yarn.control) point = change(point);
    }
    return scene;
}

/// Checks that the energy is the same and each pull the same but for `turn`.
void check_same(const SimScene& scene, const SimScene& other, const Eigen::Matrix3d& turn) {
    Bench a(scene), b(other);
    const double energy = a.evaluate();
    CHECK(b.evaluate() == Approx(energy).epsilon(1e-10));
    const double scale = size_of(a.gradient);
    REQUIRE(scale > 1e-3);
    for (std::size_t slot = 0; slot < a.fabric.slots(); ++slot)
        CHECK((turn * load(&a.gradient[3 * slot]) - load(&b.gradient[3 * slot])).norm() < 1e-9 * scale);
}

SimScene shaken_weave(Random& random) {
    WeaveShape shape;
    shape.swing = 0.7;
    SimScene scene = plain_weave(shape);
    for (SimYarn& yarn : scene.yarns) shake(random, yarn, 0.02);
    return scene;
}

}  // namespace

TEST_CASE("what lies free pulls itself nowhere and turns itself nowhere") {
    weave::testing::for_all(
        [](Random& random) {
            Bench bench(heap(random, random.between(1, 4), 0.05));
            for (const Terms terms : {Terms{true, false}, Terms{false, true}}) {
                bench.evaluate(terms);
                Vec3 force(0, 0, 0), torque(0, 0, 0);
                for (std::size_t slot = 0; slot < bench.fabric.slots(); ++slot) {
                    const Vec3 pull = load(&bench.gradient[3 * slot]);
                    force += pull;
                    torque += load(&bench.state[3 * slot]).cross(pull);
                }
                const double scale = size_of(bench.gradient);
                CHECK(force.norm() <= 1e-12 * scale);
                CHECK(torque.norm() <= 1e-12 * scale);
            }
        },
        50);
}

TEST_CASE("a periodic cloth pulls itself nowhere") {
    weave::testing::for_all(
        [](Random& random) {
            Bench bench(shaken_weave(random));
            bench.evaluate();
            Vec3 force(0, 0, 0);
            for (std::size_t slot = 0; slot < bench.fabric.slots(); ++slot)
                force += load(&bench.gradient[3 * slot]);
            CHECK(force.norm() < 1e-12 * size_of(bench.gradient));
        },
        20);
}

TEST_CASE("nothing depends on where the cloth lies") {
    weave::testing::for_all(
        [](Random& random) {
            const Vec3 by = jitter(random, 5);
            const auto move = [&](const Vec3& point) { return Vec3(point + by); };
            const SimScene weave = shaken_weave(random), loose = heap(random, 3, 0.05);
            check_same(weave, changed(weave, move), Eigen::Matrix3d::Identity());
            check_same(loose, changed(loose, move), Eigen::Matrix3d::Identity());
        },
        10);
}

TEST_CASE("nothing depends on how what lies free is turned") {
    weave::testing::for_all(
        [](Random& random) {
            const Vec3 axis = random.coin() ? Vec3(0, 0, 1) : Vec3(jitter(random, 1).normalized());
            const Eigen::Matrix3d turn = Eigen::AngleAxisd(uniform(random, -3, 3), axis).toRotationMatrix();
            const SimScene scene = heap(random, 3, 0.05);
            check_same(scene, changed(scene, [&](const Vec3& point) { return Vec3(turn * point); }), turn);
        },
        20);
}

TEST_CASE("a yarn moved by whole periods is the same yarn") {
    weave::testing::for_all(
        [](Random& random) {
            const SimScene scene = shaken_weave(random);
            SimScene other = scene;
            for (SimYarn& yarn : other.yarns) {
                const Vec3 by(scene.period_mm[0] * (static_cast<double>(random.between(0, 6)) - 3),
                              scene.period_mm[1] * (static_cast<double>(random.between(0, 6)) - 3), 0);
                for (Vec3& point : yarn.control) point += by;
            }
            check_same(scene, other, Eigen::Matrix3d::Identity());
        },
        20);
}

TEST_CASE("a repeat twice as large holds the same yarns, so twice the energy") {
    WeaveShape small, large;
    large.count = 4;
    small.swing = large.swing = 0.7;
    Bench a(plain_weave(small)), b(plain_weave(large));
    CHECK(b.evaluate() == Approx(4 * a.evaluate()).epsilon(1e-10));
}
