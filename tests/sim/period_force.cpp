// The force with which a periodic cloth pulls at its period: -∂E/∂P.

#include "scenes.hpp"

#include <weave/sim/relax.hpp>

#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

/// The scene with another period in x; its control points stay where they are.
SimScene with_period(SimScene scene, double period) {
    const double longer = period - scene.period_mm[0];
    scene.period_mm[0] = period;
    for (SimYarn& yarn : scene.yarns) yarn.shift.x() += yarn.turns[0] * longer;
    return scene;
}

double energy_at(const SimScene& scene, double period) {
    return Bench(with_period(scene, period)).evaluate();
}

/// What the bodies say passes through the boundary: the forces on the points beyond it, and those of contact
/// with images.
double pull_through_boundary(Bench<double>& bench) {
    bench.evaluate();
    const FabricView<double> view = bench.energy.view(bench.state);
    std::vector<double> energy(bench.fabric.segments()), gradient(12 * bench.fabric.segments());
    const SegmentForces<double> forces{view, {}, energy.data(), gradient.data()};
    std::vector<int> turns(bench.fabric.slots(), 0);
    for (const FollowSlot& follow : bench.fabric.follows()) {
        const SimYarn& yarn = bench.fabric.scene().yarns[bench.fabric.yarn_of_slot()[follow.slot]];
        turns[follow.slot] = follow.turns * yarn.turns[0];
    }
    double pull = 0;
    for (std::size_t s = 0; s < bench.fabric.segments(); ++s) {
        forces(s);
        for (std::size_t c = 0; c < 4; ++c)
            pull += turns[view.segments[s].slot + c] * gradient[12 * s + 3 * c];
    }
    const Neighbours<double>& neighbours = bench.energy.neighbours();
    const SamplesView<double>& all = view.samples;
    for (std::size_t a = 0; a < bench.fabric.samples(); ++a) {
        for (std::uint32_t e = view.first_neighbour[a]; e < view.first_neighbour[a + 1]; ++e) {
            const std::uint32_t b = view.neighbours[e];
            const double image =
                std::round((all.x[b] - all.x[neighbours.own(b)]) / bench.fabric.scene().period_mm[0]);
            const Vec3 apart(all.x[b] - all.x[a], all.y[b] - all.y[a], all.z[b] - all.z[a]);
            const double reach = all.radius[a] + all.radius[b];
            const ContactLaw<double> law =
                ContactLaw<double>::at(apart.squaredNorm() / (reach * reach), view.floor);
            pull += image * all.weight[a] * all.weight[b] * law.slope * apart.x() /
                    (reach * reach);  // half: both sides tell it
        }
    }
    return pull;
}

}  // namespace

TEST_CASE("what passes through a periodic boundary is the change of energy with the period") {
    weave::testing::for_all(
        [](Random& random) {
            SimScene scene = plain_weave({.points_a_crossing = random.between(2, 4),
                                          .pitch_mm = uniform(random, 0.3, 0.6),
                                          .swing = 0.7});
            for (SimYarn& yarn : scene.yarns) shake(random, yarn, 0.02);
            Bench bench(scene);
            const double period = scene.period_mm[0], step = 1e-7 * period;
            const double wanted =
                (energy_at(scene, period + step) - energy_at(scene, period - step)) / (2 * step);
            CHECK(pull_through_boundary(bench) == Approx(wanted).epsilon(1e-5).margin(1e-6));
        },
        20);
}

TEST_CASE("at rest that force is also the change of the energy at rest") {
    Random random(weave::testing::run_seed());
    INFO("WEAVE_SEED=" << weave::testing::run_seed());
    SimScene scene = plain_weave({.swing = 0.7});
    for (SimYarn& yarn : scene.yarns) shake(random, yarn, 0.01);
    const double period = scene.period_mm[0], step = 1e-3 * period;
    double pull = 0;
    const auto at_rest = [&](double at) {  // goes on from the rest before, so that it stays in one basin
        SimScene changed = with_period(scene, at);
        for (SimYarn& yarn : changed.yarns) {
            for (Vec3& point : yarn.control) point.x() *= at / period;
        }
        Bench bench(changed);
        const RelaxResult result = relax(bench.energy, bench.state, {.residual = 1e-8, .watch = {}});
        CHECK(result.ending == Ending::converged);
        pull = pull_through_boundary(bench);
        if (at == period) {
            const std::vector<std::vector<Vec3>> control = bench.fabric.control(bench.state);
            for (std::size_t y = 0; y < control.size(); ++y) scene.yarns[y].control = control[y];
        }
        return result.energy;
    };
    at_rest(period);
    at_rest(period);  // once more: samples follow from the lengths at the start
    const double wanted = pull, more = at_rest(period + step), less = at_rest(period - step);
    pull = wanted;
    CHECK(pull == Approx((more - less) / (2 * step)).epsilon(1e-3));
    CHECK(pull > 0);
    CHECK(pull < 2 * 40 * 0.02);  // two warps pull with 0.8 N each along their slopes; wefts push them apart
}
