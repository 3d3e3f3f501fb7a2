#pragma once

#include "bench.hpp"
#include "support/machines.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using namespace weave::sim;
using namespace weave::sim::testing;

template <class Real>
struct PullAll {
    ClothView<Real> cloth;
    ListsView<Real> lists;
    ForcesRoom<Real> room;
    View<const double> at;
    Real give;
    Terms terms;
    View<Real> gradient;
    View<double> energy;  ///< one

    template <class Crew>
    WEAVE_HD void operator()(Crew& crew) const {
        const double sum = pull(crew, cloth, lists, room, at, give, terms, gradient);
        crew.alone(device_tests::TellIt<double>{energy, sum});
    }
};

/// Energy, and forces in bench.gradient.
template <class Real, class Machine>
double pull_on(DeviceBench<Real, Machine>& bench, Real give, Terms terms) {
    const ListsView<Real> lists = bench.listed();
    const Array<double> energy(bench.machine.memory, 1);
    bench.machine.run(PullAll<Real>{bench.cloth, lists, bench.forces(), bench.at(), give, terms, bench.gradient.view(), energy.view()});
    return energy.get().front();
}

/// Energy and forces against the processor's, errors as shares of the greatest force and of the energy of all terms.
template <class Real, class Machine>
void check_forces(Machine& machine, const SimScene& scene, Terms terms, double give, double tolerance) {
    DeviceBench<Real, Machine> bench(machine, scene);
    bench.host.energy.give_beyond(give);
    const double right = bench.host.evaluate(terms), energy = pull_on(bench, static_cast<Real>(give), terms);
    const std::vector<Real> gradient = bench.gradient.get();
    const std::vector<double> expected = [&] {
        std::vector<double> rows;
        for (std::size_t slot = 0; slot < bench.host.fabric.slots(); ++slot) {
            if (bench.host.fabric.moves()[slot] == 0) continue;
            for (std::size_t k = 0; k < 3; ++k) rows.push_back(bench.host.gradient[3 * slot + k]);
        }
        return rows;
    }();
    REQUIRE(expected.size() == gradient.size());
    double most = 1e-3, error = 0;
    for (const double force : expected) most = std::max(most, std::abs(force));
    for (std::size_t i = 0; i < expected.size(); ++i) error = std::max(error, std::abs(static_cast<double>(gradient[i]) - expected[i]));
    CHECK(error / most < tolerance);
    CHECK(std::abs(energy - right) < tolerance * std::max(1e-3, std::abs(right)));
}

}  // namespace

TEMPLATE_TEST_CASE("forces: energy and gradient are the processor's", "[device]", WEAVE_MACHINES) {
    TestType machine;
    for (const NamedScene& named : every_scene()) {
        INFO(named.name);
        for (const Terms terms : {Terms{true, true}, Terms{true, false}, Terms{false, true}}) {
            for (const double give : {1e300, 0.01}) {
                INFO("elastic " << terms.elastic << ", contact " << terms.contact << ", gives beyond " << give);
                check_forces<double>(machine, named.scene, terms, give, 2e-10 * named.rounding);
                check_forces<float>(machine, named.scene, terms, std::min(give, 1e30), 2e-5);
            }
        }
    }
}

TEMPLATE_TEST_CASE("forces: every time the same, on the processor those of one thread", "[device]", WEAVE_MACHINES) {
    TestType machine;
    device_tests::OneThread one_thread;
    for (const NamedScene& named : every_scene()) {
        INFO(named.name);
        DeviceBench<float, TestType> bench(machine, named.scene);
        const double first = pull_on(bench, 1e30F, {});
        const std::vector<float> gradient = bench.gradient.get();
        CHECK(pull_on(bench, 1e30F, {}) == first);
        CHECK(bench.gradient.get() == gradient);
        if (!device_tests::round_as_one_thread) continue;
        DeviceBench<float, device_tests::OneThread> alone(one_thread, named.scene);
        CHECK(pull_on(alone, 1e30F, {}) == Approx(first).epsilon(1e-12));
        CHECK(alone.gradient.get() == gradient);
    }
}
