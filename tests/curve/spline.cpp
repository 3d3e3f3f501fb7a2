#include "support/random.hpp"

#include <weave/curve/spline.hpp>

#include <catch2/catch.hpp>

#include <cmath>

using namespace weave;
using namespace weave::testing;

namespace {

double number(Random& random) {
    return static_cast<double>(random.between(0, 2000)) / 1000 - 1;
}

std::vector<Vec3> random_keys(Random& random, std::size_t count) {
    std::vector<Vec3> keys;
    for (std::size_t k = 0; k < count; ++k) keys.emplace_back(number(random), number(random), number(random));
    return keys;
}

Spline random_spline(Random& random, std::vector<Vec3>& keys, std::size_t most = 12) {
    keys = random_keys(random, random.between(1, most));
    return interpolate(keys, random.coin(), Vec3(number(random), 3 + number(random), 0));
}

void check_near(const Vec3& a, const Vec3& b, double tolerance = 1e-12) {
    CAPTURE(a.transpose(), b.transpose());
    CHECK((a - b).norm() <= tolerance);
}

}  // namespace

TEST_CASE("A spline passes its keys, and a periodic one again after each shift") {
    for_all(
        [](Random& random) {
            std::vector<Vec3> keys;
            const Spline spline = random_spline(random, keys);
            const auto n = static_cast<double>(keys.size());
            REQUIRE(spline.control.size() == keys.size());
            for (std::size_t k = 0; k < keys.size(); ++k) {
                const auto t = static_cast<double>(k);
                check_near(spline.place(t), keys[k]);
                if (!spline.is_periodic) continue;
                check_near(spline.place(t + n), keys[k] + spline.shift);
                check_near(spline.place(t - 2 * n), keys[k] - 2 * spline.shift, 1e-11);
            }
        },
        500);
}

TEST_CASE("A spline and its two derivatives have no step at a key, and the derivatives are the true ones") {
    for_all(
        [](Random& random) {
            std::vector<Vec3> keys;
            const Spline spline = random_spline(random, keys);
            if (spline.segments() == 0) return;
            const double tiny = 1e-9;
            for (std::size_t k = 0; k <= spline.segments(); ++k) {
                const auto t = static_cast<double>(k);
                if (!spline.is_periodic && (k == 0 || k == spline.segments())) {
                    check_near(spline.bend(t), Vec3::Zero());
                    continue;
                }
                check_near(spline.place(t - tiny), spline.place(t), 1e-7);
                check_near(spline.tangent(t - tiny), spline.tangent(t), 1e-6);
                check_near(spline.bend(t - tiny), spline.bend(t), 1e-6);
            }
            const double t = 0.37, h = 1e-5;
            check_near((spline.place(t + h) - spline.place(t - h)) / (2 * h), spline.tangent(t), 1e-8);
            check_near((spline.tangent(t + h) - spline.tangent(t - h)) / (2 * h), spline.bend(t), 1e-8);
        },
        500);
}

TEST_CASE("Periodic splines of one, two and three keys") {
    const Vec3 shift(0, 6, 0);
    const Spline one = interpolate({Vec3(1, 2, 3)}, true, shift);
    check_near(one.place(0.25), Vec3(1, 3.5, 3));
    check_near(one.tangent(0.8), shift);
    check_near(one.bend(0.8), Vec3::Zero());

    // Of two keys the heights -1 and 1 are joined by the cubic with no slope at either.
    const Spline two = interpolate({Vec3(0, 0, -1), Vec3(0, 3, 1)}, true, shift);
    check_near(two.place(0.5), Vec3(0, 1.5, 0));
    check_near(two.place(0.25), Vec3(0, 0.75, -1 + 2 * (3 * 0.0625 - 2 * 0.015625)));
    check_near(two.tangent(1), Vec3(0, 3, 0));

    const Spline three = interpolate({Vec3(0, 0, 1), Vec3(0, 2, 0), Vec3(0, 4, 0)}, true, shift);
    check_near(three.place(1.3), three.place(1.7).cwiseProduct(Vec3(1, 0, 1)) + Vec3(0, 2.6, 0));
    check_near(three.place(3), Vec3(0, 6, 1));
}

TEST_CASE("Straight lines stay straight") {
    std::vector<Vec3> keys;
    for (int k = 0; k < 7; ++k) keys.emplace_back(k * 0.5, 2, 3 - k * 0.25);
    for (const bool is_periodic : {false, true}) {
        const Spline spline = interpolate(keys, is_periodic, Vec3(3.5, 0, -1.75));
        for (double t = 0; t < 6; t += 0.37) {
            check_near(spline.place(t), Vec3(t * 0.5, 2, 3 - t * 0.25));
            check_near(spline.bend(t), Vec3::Zero());
        }
    }
}

TEST_CASE("Resampling to a multiple of the segments keeps the curve") {
    for_all(
        [](Random& random) {
            std::vector<Vec3> keys;
            const Spline spline = random_spline(random, keys);
            if (spline.segments() == 0) return;
            const std::size_t times = random.between(1, 4), segments = spline.segments() * times;
            const Spline finer = resample(spline, segments + (spline.is_periodic ? 0 : 1));
            REQUIRE(finer.segments() == segments);
            for (double t = 0; t <= static_cast<double>(spline.segments()); t += 0.19) {
                check_near(finer.place(t * static_cast<double>(times)), spline.place(t));
            }
        },
        500);
}

TEST_CASE("Resampling to any other number runs through the places asked for") {
    const Spline spline =
        interpolate({Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(2, 0, 0), Vec3(3, 1, 1)}, false, Vec3::Zero());
    const Spline five = resample(spline, 5);
    REQUIRE(five.control.size() == 5);
    for (int k = 0; k < 5; ++k) check_near(five.place(k), spline.place(k * 0.75));
    CHECK((five.place(0.5) - spline.place(0.375)).norm() > 1e-6);
}

TEST_CASE("Bézier points give the same cubic") {
    for_all(
        [](Random& random) {
            std::vector<Vec3> keys;
            const Spline spline = random_spline(random, keys);
            for (std::size_t k = 0; k < spline.segments(); ++k) {
                const auto b = bezier(spline, k);
                check_near((b[0] + 3 * b[1] + 3 * b[2] + b[3]) / 8,
                           spline.place(static_cast<double>(k) + 0.5));
                check_near(b[0], spline.place(static_cast<double>(k)));
            }
        },
        200);
}
