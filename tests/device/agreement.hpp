#pragma once

// Samples on a device against the processor, from the same start near the same rest: cloth has many rests, and from its planned start
// one rounding decides between them (docs/simulation.md).

#include "support/relaxed.hpp"

#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/order.hpp>
#include <weave/sim/plan.hpp>

#include <string>
#include <vector>

namespace device_tests {

struct Agreement {
    bool was_at_rest = false;  ///< the processor, within its time
    double apart = 0;          ///< radii, after both went on to 1e-8
    double rough_apart = 0;    ///< before: float at standard's goal against the rest
    double force = 0, energy = 0;  ///< relative difference of the contact forces, greatest against greatest; of the energy, below 0 where the device's is lower
    double judged = 0;         ///< residual at the device's rest by the processor's forces
    bool keeps_order = false;
    Ending ending = Ending::stuck;
};

inline std::vector<Spline> in_plan(const Plan& plan, const std::vector<Spline>& of_scene) {
    std::vector<Spline> all(plan.curves.yarns.size());
    for (std::size_t y = 0; y < of_scene.size(); ++y) all[plan.curve_of[y]] = of_scene[y];
    return all;
}

/// A state up to `push` radii beside another.
inline std::vector<double> beside(const Fabric<double>& fabric, std::vector<double> state, double push) {
    Random random(3);
    for (std::size_t slot = 0; slot < fabric.slots(); ++slot) {
        for (std::size_t k = 0; k < 3 && fabric.moves()[slot] != 0; ++k)
            state[3 * slot + k] += uniform(random, -push, push) * fabric.least_reach() / 2;
    }
    fabric.follow(state);
    return state;
}

/// By how much what yarns press one another with differs in two states: of a control point at most, as a share of the greatest.
inline double contact_difference(Bench<double>& bench, const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> of_a, of_b;
    bench.energy.evaluate(a, of_a, {.elastic = false, .contact = true});
    bench.energy.evaluate(b, of_b, {.elastic = false, .contact = true});
    const double greatest = greatest_force(bench.executor, of_b);
    for (std::size_t i = 0; i < of_a.size(); ++i) of_a[i] -= of_b[i];
    return greatest > 0 ? greatest_force(bench.executor, of_a) / greatest : 0;
}

/// Both begin at one state a hundredth of a radius beside the processor's rest, with one energy: Energy::first_weights() are part of it.
template <class Relaxer>
Agreement agreement_on(Relaxer& relaxer, const Plan& plan, double most_seconds) {
    RelaxOptions exact = to(1e-8), standard = to(1e-3);
    exact.most_seconds = standard.most_seconds = most_seconds;
    exact.most_iterations = standard.most_iterations = 20000;
    Agreement found;
    Relaxed planned(plan.scene);
    const Rest rest = planned.here(exact);
    found.was_at_rest = rest.result.ending == Ending::converged;
    if (!found.was_at_rest) return found;
    Relaxed cloth(plan.scene);
    cloth.bench.state = beside(cloth.bench.fabric, rest.state, 1e-2);
    const Rest right = cloth.here(exact);
    Rest there = cloth.template there<float>(relaxer, standard);
    found.rough_apart = cloth.apart(there, right);
    there.result = relax_in_stages(relaxer.machine, cloth.bench.energy, there.state, exact);
    found.apart = cloth.apart(there, right);
    found.force = contact_difference(cloth.bench, there.state, right.state);
    found.energy = there.result.energy / right.result.energy - 1;
    found.ending = there.result.ending;
    std::vector<double> gradient;
    cloth.bench.energy.evaluate(there.state, gradient);
    found.judged = greatest_force(cloth.bench.executor, gradient) / right.result.reference_N;
    found.keeps_order = crossing_order(plan.curves, in_plan(plan, cloth.splines(there.state))).lost.empty();
    return found;
}

/// Whether they end at one rest. Where a cloth has several near by, the device may end at another, if it is lower and the processor's
/// forces find it at rest too.
template <class Relaxer>
bool check_agreement(const std::string& name, double most_seconds) {
    INFO(name);
    const weave::Design design = weave::find_sample(name)->make();
    const auto evaluation = weave::evaluate(design);
    const auto plan = make_plan(design, *evaluation->block, {});
    REQUIRE(plan);
    Relaxer relaxer;
    const Agreement found = agreement_on(relaxer, *plan, most_seconds);
    if (!found.was_at_rest) {
        WARN(name << ": the processor did not come to rest within " << most_seconds << " s");
        return false;
    }
    WARN(name << ": " << found.apart << " radii apart (" << found.rough_apart << " at 1e-3), force " << found.force << ", energy " << found.energy << ", judged " << found.judged);
    CHECK(found.ending == Ending::converged);
    CHECK(found.keeps_order);
    CHECK(found.judged < 1e-6);
    if (found.apart < 1e-4) CHECK(found.force < 1e-3);
    else CHECK(found.energy < 0);
    return found.apart < 1e-4;
}

}  // namespace device_tests

#if defined(__CUDACC__)
#define WEAVE_AGREES WEAVE_RELAXERS
#elif defined(WEAVE_WATCHES_THREADS)
#define WEAVE_AGREES device_tests::RelaxesByOneThread
#else // whoever emulates a device would take minutes; what it does is the same
#define WEAVE_AGREES device_tests::RelaxesByOneThread, device_tests::RelaxesByTwoCores
#endif

TEMPLATE_TEST_CASE("agreement: small samples lie where the processor lays them", "[device][slow]", WEAVE_AGREES) {
    for (const char* name : {"plain", "twill-2-2", "satin-5", "basket", "layer-to-layer"})
        CHECK(device_tests::check_agreement<TestType>(name, 60));
}

// One of them alone: test_device "agreement: every*" -c NAME
TEMPLATE_TEST_CASE("agreement: every sample of up to 100000 points that the processor brings to rest", "[.][long][agreement]", WEAVE_AGREES) {
    for (const char* name : {"plain", "twill-2-2", "satin-5", "sateen-8", "rib", "basket", "herringbone", "satin-e", "twill-g", "layer-to-layer",
                             "angle-interlock-a", "angle-interlock-b", "orthogonal", "stitched-layers", "tl013-wrong", "tl013-corrected"}) {
        DYNAMIC_SECTION(name) { CHECK(device_tests::check_agreement<TestType>(name, 120)); }
    }
    // Hexagon tubes have many rests within a hundredth of a radius (docs/simulation.md); the others do not come to rest in that time here.
    for (const char* name : {"hexagon-tubes", "i-beam", "pocket", "three-colour-stencil", "shoe-baby"}) {
        DYNAMIC_SECTION(name) { device_tests::check_agreement<TestType>(name, 120); }
    }
}
