#pragma once

// Whole relaxations, against the processor's own solver.

#include "support/relaxed.hpp"

using device_tests::Relaxed;
using device_tests::Rest;
using device_tests::to;

TEMPLATE_TEST_CASE("relaxation: in double it comes to rest where the processor does", "[device]", WEAVE_RELAXERS) {
    using namespace device_tests;
    for (const auto& [name, scene] : several(TestType::weave)) {
        INFO(name);
        TestType relaxer;
        Relaxed cloth(scene);
        const Rest right = cloth.here(to(1e-8)), found = cloth.there<double>(relaxer, to(1e-8));
        CHECK(found.result.ending == right.result.ending);
        CHECK(found.result.residual <= 1e-8);
        CHECK(cloth.apart(found, right) < 1e-4);
        CHECK(found.result.energy == Approx(right.result.energy).epsilon(1e-7));
        CHECK(found.result.reference_N == Approx(right.result.reference_N).epsilon(1e-5));
        CHECK(found.result.curves_down == right.result.curves_down);
    }
}

TEMPLATE_TEST_CASE("relaxation: in float it comes to standard's rest, and from there to the processor's", "[device]", WEAVE_RELAXERS) {
    using namespace device_tests;
    for (const auto& [name, scene] : several(TestType::weave)) {
        INFO(name);
        TestType relaxer;
        Relaxed cloth(scene);
        const Rest right = cloth.here(to(1e-8));
        Rest found = cloth.there<float>(relaxer, to(1e-3));
        CHECK(found.result.ending == Ending::converged);
        CHECK(found.result.residual <= 1e-3);
        // What it says of its residual holds in double too.
        cloth.bench.energy.evaluate(found.state, cloth.bench.gradient);
        CHECK(greatest_force(cloth.bench.executor, cloth.bench.gradient) / reference_force(cloth.bench.energy, found.state) < 1.05e-3);
        found.result = relax(cloth.bench.energy, found.state, to(1e-8));
        CHECK(cloth.apart(found, right) < 1e-4);
        CHECK(found.result.reference_N == Approx(right.result.reference_N).epsilon(1e-3));
    }
}

TEMPLATE_TEST_CASE("relaxation: float as far as it leads, then double", "[device]", WEAVE_RELAXERS) {
    using namespace device_tests;
    TestType relaxer;
    Relaxed cloth(shaken_weave(TestType::weave));
    const Rest right = cloth.here(to(1e-8));
    Rest found{{}, cloth.bench.state};
    std::size_t watched = 0;
    double last_seconds = 0;
    RelaxOptions options = to(1e-8);
    options.watch = [&](const Progress& progress) {
        ++watched;
        CHECK(progress.seconds >= last_seconds);
        last_seconds = progress.seconds;
        return true;
    };
    found.result = relax_in_stages(relaxer.machine, cloth.bench.energy, found.state, options);
    CHECK(found.result.ending == Ending::converged);
    CHECK(found.result.residual <= 1e-8);
    CHECK(cloth.apart(found, right) < 1e-4);
    CHECK(watched > 1);
    bool rises = true;
    for (std::size_t r = 1; r < found.result.history.size(); ++r)
        rises = rises && found.result.history[r].iteration >= found.result.history[r - 1].iteration;
    CHECK(rises);
    CHECK(found.result.history.back().iteration == found.result.iterations);
}

TEMPLATE_TEST_CASE("relaxation: the same bits every time", "[device]", WEAVE_RELAXERS) {
    using namespace device_tests;
    TestType relaxer;
    Relaxed cloth(shaken_weave(TestType::weave));
    const Rest first = cloth.there<float>(relaxer, to(1e-3)), second = cloth.there<float>(relaxer, to(1e-3));
    CHECK(first.state == second.state);
    CHECK(first.result.evaluations == second.result.evaluations);
}

TEMPLATE_TEST_CASE("relaxation: it ends when steps or time are used up, or who watches says so", "[device]", WEAVE_RELAXERS) {
    using namespace device_tests;
    TestType relaxer;
    Relaxed cloth(shaken_weave(TestType::weave));
    RelaxOptions options = to(1e-9);
    options.most_iterations = 5;
    const Rest few = cloth.there<float>(relaxer, options);
    CHECK(few.result.ending == Ending::iterations);
    CHECK(few.result.iterations == 5);
    CHECK(few.result.history.size() == 6);
    options = to(1e-9);
    options.most_seconds = 0;
    CHECK(cloth.there<float>(relaxer, options).result.ending == Ending::time);
    options = to(1e-9);
    std::size_t looks = 0;
    options.watch = [&](const Progress&) { return ++looks < 3; };
    const Rest stopped = cloth.there<float>(relaxer, options);
    CHECK(stopped.result.ending == Ending::stopped);
    CHECK(looks == 3);
    // What is told of the state it ended with is true of it.
    std::vector<double> state = stopped.state;
    const double energy = cloth.bench.energy.evaluate(state, cloth.bench.gradient);
    CHECK(energy == Approx(stopped.result.energy).epsilon(1e-5));
}

TEMPLATE_TEST_CASE("relaxation: who watches sees the state that is told of", "[device]", WEAVE_RELAXERS) {
    using namespace device_tests;
    TestType relaxer;
    Relaxed cloth(shaken_weave(TestType::weave));
    std::vector<double> state = cloth.bench.state;
    RelaxOptions options = to(1e-6);
    std::size_t looks = 0;
    Bench<double> other(shaken_weave(TestType::weave));
    options.watch = [&](const Progress& progress) {
        CHECK(other.energy.evaluate(state, other.gradient) == Approx(progress.energy).epsilon(1e-5));
        ++looks;
        return looks < 4;
    };
    relax_on<float>(relaxer.machine, cloth.bench.energy, state, options);
    CHECK(looks == 4);
}

TEMPLATE_TEST_CASE("relaxation: a rest that is a saddle is left", "[device]", WEAVE_RELAXERS) {
    using namespace device_tests;
    Relaxed rod(pressed_rod());
    TestType relaxer;
    RelaxOptions options = to(1e-6);
    const Rest right = rod.here(options), left = rod.there<double>(relaxer, options);
    CHECK(left.result.energy == Approx(right.result.energy).epsilon(1e-4));
    options.leaves_saddles = false;
    const Rest straight = rod.there<double>(relaxer, options);
    CHECK(left.result.energy < 0.9 * straight.result.energy);
}

TEMPLATE_TEST_CASE("relaxation: room is made where lists are longer than was foreseen", "[device]", WEAVE_RELAXERS) {
    using namespace device_tests;
    // So small a repeat that a sample has many images, and meets many samples.
    SimScene scene = plain_weave({.count = 2, .points_a_crossing = 2, .pitch_mm = 0.24});
    scene.sample_spacing = 0.1;
    TestType relaxer;
    Relaxed cloth(scene);
    std::vector<double> state = cloth.bench.state;
    const RelaxOptions options = to(1e-3);
    using Machine = std::remove_reference_t<decltype(relaxer.machine)>;
    RelaxingCloth<float, typename Machine::Crew> relaxing(relaxer.machine.memory(), cloth.bench.energy, state, options);
    const std::size_t at_first = relaxing.bytes();
    lead<float>(relaxer.machine, relaxing);
    CHECK(relaxing.result().ending == Ending::converged);
    CHECK(relaxing.bytes() > at_first);
}

TEMPLATE_TEST_CASE("relaxation: nothing, one yarn, and yarns that are all held", "[device]", WEAVE_RELAXERS) {
    using namespace device_tests;
    TestType relaxer;
    CHECK(Relaxed(SimScene{}).there<float>(relaxer, to(1e-3)).result.ending == Ending::converged);
    SimScene one;
    one.yarns.push_back(laid(usual_yarn(), Vec3(0, 0, 0), Vec3(1, 0, 0), 6));
    one.yarns.back().is_fed = false;
    CHECK(Relaxed(one).there<float>(relaxer, to(1e-3)).result.ending == Ending::converged);
    SimScene held = plain_weave({});
    for (SimYarn& yarn : held.yarns) yarn.frozen.assign(yarn.control.size(), 1);
    Relaxed cloth(held);
    const Rest rest = cloth.there<float>(relaxer, to(1e-3));
    CHECK(rest.result.ending == Ending::converged);
    CHECK(rest.state == cloth.bench.state);
}

TEMPLATE_TEST_CASE("relaxation: both stages count, and either may be the last", "[device]", WEAVE_RELAXERS) {
    using namespace device_tests;
    TestType relaxer;
    Relaxed cloth(shaken_weave(TestType::weave));
    const auto in_stages = [&](const RelaxOptions& options) {
        Rest rest{{}, cloth.bench.state};
        rest.result = relax_in_stages(relaxer.machine, cloth.bench.energy, rest.state, options);
        return rest;
    };
    const Rest rough = in_stages(to(least_float_residual)), whole = in_stages(to(1e-8));
    REQUIRE(whole.result.ending == Ending::converged);
    REQUIRE(whole.result.iterations > rough.result.iterations + 1);
    CHECK(whole.result.evaluations > rough.result.evaluations);
    CHECK(rough.result.builds > 0);
    CHECK(whole.result.builds > rough.result.builds);
    CHECK(whole.result.seconds >= whole.result.history.back().seconds);
    RelaxOptions options = to(1e-8);
    options.most_iterations = rough.result.iterations + 1;
    const Rest few = in_stages(options);
    CHECK(few.result.ending == Ending::iterations);
    CHECK(few.result.iterations == options.most_iterations);
    options = to(1e-8);
    options.watch = [&](const Progress& progress) { return progress.residual > least_float_residual; };
    const Rest stopped = in_stages(options);
    CHECK(stopped.result.ending == Ending::stopped);
    CHECK(stopped.result.residual <= least_float_residual);
}

TEMPLATE_TEST_CASE("relaxation: points that lie on one another are spread, and yarns that are laid too long give way", "[device]", WEAVE_RELAXERS) {
    using namespace device_tests;
    TestType relaxer;
    SimScene scene = held_weave(TestType::weave);
    for (SimYarn& yarn : scene.yarns) {
        if (yarn.control.size() > 4) yarn.control[2] = yarn.control[3];
    }
    scene.yarns.back().is_fed = false;
    scene.yarns.back().rest_mm /= 1.3;
    Relaxed cloth(scene);
    const Rest right = cloth.here(to(1e-8)), found = cloth.there<double>(relaxer, to(1e-8));
    CHECK(found.result.ending == right.result.ending);
    CHECK(cloth.apart(found, right) < 1e-4);
    CHECK(found.result.energy == Approx(right.result.energy).epsilon(1e-7));
}

TEMPLATE_TEST_CASE("relaxation: cloths next to one another come to rest as each alone would", "[device]", WEAVE_BATCH_RELAXERS) {
    using namespace device_tests;
    TestType relaxer;
    std::vector<std::unique_ptr<Relaxed>> cloths;
    std::vector<Rest> found;
    std::vector<ClothToRelax> all;
    for (const auto& [name, scene] : several(TestType::weave)) cloths.push_back(std::make_unique<Relaxed>(scene));
    cloths.push_back(std::make_unique<Relaxed>(SimScene{}));
    for (const auto& cloth : cloths) found.push_back({{}, cloth->bench.state});
    const double goals[]{1e-8, 1e-3, 1e-8, 1e-6, 1e-8};  // one of them is reached in float
    for (std::size_t k = 0; k < cloths.size(); ++k) all.push_back({&cloths[k]->bench.energy, &found[k].state, to(goals[k])});
    const std::vector<RelaxResult> results = relax_each_in_stages(relaxer.machine, std::span<const ClothToRelax>(all));
    REQUIRE(results.size() == cloths.size());
    for (std::size_t k = 0; k < cloths.size(); ++k) {
        INFO("cloth " << k);
        found[k].result = results[k];
        CHECK(results[k].ending == Ending::converged);
        CHECK(results[k].residual <= goals[k]);
        CHECK((results[k].history.empty() || results[k].history.back().iteration == results[k].iterations));
        const auto sooner = [](const Progress& a, const Progress& b) { return a.seconds < b.seconds; };
        CHECK(std::ranges::is_sorted(results[k].history, sooner));
        CHECK((results[k].history.empty() || results[k].seconds >= results[k].history.back().seconds));
        if (found[k].state.empty()) continue;
        if (goals[k] > 1e-4) found[k].result = relax(cloths[k]->bench.energy, found[k].state, to(1e-8));
        CHECK(cloths[k]->apart(found[k], cloths[k]->here(to(1e-8))) < 1e-4);
    }
}

TEMPLATE_TEST_CASE("relaxation: of cloths next to one another each ends for itself", "[device]", WEAVE_BATCH_RELAXERS) {
    using namespace device_tests;
    TestType relaxer;
    Relaxed stopped(shaken_weave(TestType::weave)), short_of_steps(shaken_weave(TestType::weave)), whole(held_weave(TestType::weave));
    std::vector<double> states[]{stopped.bench.state, short_of_steps.bench.state, whole.bench.state};
    std::size_t looks = 0;
    RelaxOptions watched = to(1e-9), few = to(1e-9);
    watched.watch = [&](const Progress&) { return ++looks < 2; };
    few.most_iterations = 3;
    const std::vector<ClothToRelax> all{
        {&stopped.bench.energy, &states[0], watched}, {&short_of_steps.bench.energy, &states[1], few}, {&whole.bench.energy, &states[2], to(1e-3)}};
    const std::vector<RelaxResult> results = relax_each_on<float>(relaxer.machine, std::span<const ClothToRelax>(all));
    REQUIRE(results.size() == 3);
    CHECK(results[0].ending == Ending::stopped);
    CHECK(looks == 2);
    CHECK(results[1].ending == Ending::iterations);
    CHECK(results[1].iterations == 3);
    CHECK(results[2].ending == Ending::converged);
    CHECK(relax_each_on<float>(relaxer.machine, std::span<const ClothToRelax>{}).empty());
}
