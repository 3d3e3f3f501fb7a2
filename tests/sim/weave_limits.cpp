// Weaves whose shape is known, and how fast the discretisation comes to its limit.

#include "scenes.hpp"

#include <weave/curve/spline.hpp>
#include <weave/sim/relax.hpp>

#include <catch2/catch.hpp>

#include <cmath>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

double length_of(const Spline& spline) {
    double length = 0;
    const std::size_t pieces = 200 * spline.segments();
    for (std::size_t k = 0; k < pieces; ++k)
        length += spline.tangent((static_cast<double>(k) + 0.5) / 200).norm() / 200;
    return length;
}

/// Crimp l/p - 1 of a relaxed plain weave's first warp.
double crimp_of(const SimScene& scene, double residual) {
    Bench bench(scene);
    const RelaxResult result =
        relax(bench.energy, bench.state, {.residual = residual, .most_iterations = 3000, .watch = {}});
    CHECK(result.ending == Ending::converged);
    const SimYarn& yarn = scene.yarns[0];
    return length_of({bench.fabric.control(bench.state)[0], true, yarn.shift}) / yarn.shift.norm() - 1;
}

/// Peirce's plain weave with both systems alike: p = (l - Dθ) cos θ + D sin θ, h = (l - Dθ) sin θ + D (1 -
/// cos θ) = D/2, D being both diameters together. Crimp l/p - 1 at a pitch p.
double peirce_crimp(double pitch, double both_diameters) {
    double low = 0, high = std::numbers::pi / 2, crimp = 0;
    for (int halving = 0; halving < 80; ++halving) {
        const double turn = (low + high) / 2, d = both_diameters;
        const double straight = (d / 2 - d * (1 - std::cos(turn))) / std::sin(turn);
        const double p = straight * std::cos(turn) + d * std::sin(turn);
        crimp = (straight + d * turn) / pitch - 1;
        (p > pitch ? low : high) = turn;
    }
    return crimp;
}

/// A plain weave of yarns that hardly bend stiffly and hardly give way, both systems under the same tension.
SimScene limp_weave(double pitch, double contact, std::size_t points_a_crossing) {
    SimScene scene = plain_weave({.points_a_crossing = points_a_crossing, .pitch_mm = pitch});
    for (SimYarn& yarn : scene.yarns) {
        yarn.is_fed = true;
        yarn.bending_N_mm2 = 1e-7;
        yarn.contact_N_mm2 = contact;
        // Off the symmetric places, which hold whatever the forces are.
        for (std::size_t i = 0; i < yarn.control.size(); ++i)
            yarn.control[i].z() *= 1 + 0.02 * std::sin(static_cast<double>(i));
    }
    scene.sample_spacing = 0.1;
    return scene;
}

}  // namespace

TEST_CASE("limp yarns that do not give way lie as Peirce's plain weave") {
    for (const double pitch : {0.6, 0.9}) {
        const double wanted = peirce_crimp(pitch, 4 * 0.12);
        double errors[3];
        for (const int k : {0, 1, 2})
            errors[k] = crimp_of(limp_weave(pitch, 3 * std::pow(10, 2 * k), 12), 1e-4) - wanted;
        std::printf("Peirce, pitch %.1f: crimp %.4f; off by %.4f, %.4f, %.4f with k = 3, 300, 30000\n", pitch,
                    wanted, errors[0], errors[1], errors[2]);
        CHECK(std::abs(errors[2]) < 0.03 * wanted);
        CHECK(std::abs(errors[2]) < std::abs(errors[0]));
    }
}

TEST_CASE("a plain weave converges under refinement, and its order is told") {
    double crimp[4];
    for (const int k : {0, 1, 2, 3}) {
        SimScene scene = plain_weave({.points_a_crossing = std::size_t{2} << k});
        scene.sample_spacing = 0.05;  // so that what is left is the spline's error
        crimp[k] = crimp_of(scene, 1e-7);
    }
    const double first = std::abs(crimp[1] - crimp[0]), second = std::abs(crimp[2] - crimp[1]),
                 third = std::abs(crimp[3] - crimp[2]);
    std::printf("plain weave, 2, 4, 8, 16 points a crossing: crimp %.6f %.6f %.6f %.6f, orders %.1f %.1f\n",
                crimp[0], crimp[1], crimp[2], crimp[3], std::log2(first / second), std::log2(second / third));
    // Two points a crossing are too few for an order; from four on halving the segments takes more than three
    // quarters off.
    CHECK(third < second / 4);
    CHECK(third < 1e-3 * crimp[3]);
}
