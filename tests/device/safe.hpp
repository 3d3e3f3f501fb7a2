#pragma once

#include "bench.hpp"
#include "support/machines.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace {

using namespace weave::sim;
using namespace weave::sim::testing;

template <class Real>
struct FindShare {
    SafeSteps<Real> safe;
    ListsView<Real> lists;
    View<const double> at;
    View<const Real> change;
    double most;
    View<double> share;  ///< one

    template <class Crew>
    WEAVE_HD void operator()(Crew& crew) const {
        const double found = safe.safe_share(crew, lists, at, change, most);
        crew.alone(device_tests::TellIt<double>{share, found});
    }
};

template <class Real>
struct ShortenAll {
    SafeSteps<Real> safe;
    ListsView<Real> lists;
    View<const double> at;
    View<Real> change;

    template <class Crew>
    WEAVE_HD void operator()(Crew& crew) const {
        safe.shorten(crew, lists, at, change);
    }
};

/// A change of the rows at random, as large as the radius.
template <class Real, class Machine>
std::vector<Real> some_change(const DeviceBench<Real, Machine>& bench, std::uint64_t seed, double size) {
    Random random(seed);
    std::vector<Real> change(3 * std::size_t(bench.cloth.rows));
    for (Real& part : change) part = static_cast<Real>(uniform(random, -size, size));
    return change;
}

template <class Real, class Machine>
double share_of(DeviceBench<Real, Machine>& bench, double most) {
    const ListsView<Real> lists = bench.listed();
    const Array<double> share(bench.machine.memory, 1);
    bench.machine.run(FindShare<Real>{bench.safe(), lists, bench.at(), bench.change.view(), most, share.view()});
    return share.get().front();
}

/// What is left of a change.
template <class Real, class Machine>
std::vector<Real> shortened(DeviceBench<Real, Machine>& bench, const std::vector<Real>& change) {
    const ListsView<Real> lists = bench.listed();
    bench.change.put(change);
    bench.machine.run(ShortenAll<Real>{bench.safe(), lists, bench.at(), bench.change.view()});
    return bench.change.get();
}

template <class Real, class Machine>
void check_share(Machine& machine, const SimScene& scene, double size, double tolerance) {
    DeviceBench<Real, Machine> bench(machine, scene);
    bench.host.evaluate();
    const std::vector<Real> change = some_change(bench, 3, size);
    bench.change.put(change);
    const double right = bench.host.energy.safe_share(bench.host.state, bench.slots_of(change), 8);
    CHECK(share_of(bench, 8) == Approx(right).epsilon(tolerance));
}

/// Two crossing yarns that all but lie on one another.
SimScene crossed_yarns() {
    SimScene scene;
    for (const int k : {0, 1}) {
        SimYarn yarn = usual_yarn();
        yarn.is_fed = false;
        const weave::Vec3 along = k == 1 ? weave::Vec3(0.3, 1, 0) : weave::Vec3(1, 0, 0), middle(0, 0, k * 0.002);
        scene.yarns.push_back(laid(yarn, middle - along, middle + along, 9));
    }
    return scene;
}

template <class Real, class Machine>
void check_pressed(Machine& machine, double tolerance) {
    DeviceBench<Real, Machine> bench(machine, crossed_yarns());
    bench.host.evaluate();
    std::vector<Real> change = some_change(bench, 7, 2e-4);
    for (std::size_t row = 0; row < bench.cloth.rows; ++row) change[3 * row + 2] += row < bench.cloth.rows / 2 ? Real(1e-3) : Real(-1e-3);
    std::vector<double> left = bench.slots_of(change);
    REQUIRE(bench.host.energy.safe_share(bench.host.state, left, 1) == 0);
    bench.host.energy.shorten(bench.host.state, left);
    const std::vector<double> found = bench.slots_of(shortened(bench, change));
    double apart = 0, moved = 0;
    for (std::size_t i = 0; i < left.size(); ++i) {
        apart = std::max(apart, std::abs(found[i] - left[i]));
        moved = std::max(moved, std::abs(left[i]));
    }
    CHECK(apart <= tolerance);
    CHECK(moved > 1e-4);
    CHECK(share_of(bench, 1) >= 0.899);
}

}  // namespace

TEMPLATE_TEST_CASE("steps: of yarns that are pressed together what is left is what the processor leaves", "[device]", WEAVE_MACHINES) {
    TestType machine;
    check_pressed<double>(machine, 1e-15);
    check_pressed<float>(machine, 1e-8);
}

TEMPLATE_TEST_CASE("steps: what is safe is what the processor holds for safe", "[device]", WEAVE_MACHINES) {
    TestType machine;
    for (const NamedScene& named : every_scene()) {
        INFO(named.name);
        for (const double size : {1e-4, 0.05, 1.0}) {
            check_share<double>(machine, named.scene, size, 1e-9);
            check_share<float>(machine, named.scene, size, 1e-3);
        }
    }
}

TEMPLATE_TEST_CASE("steps: what is left of a shortened change is safe, and goes on where it was", "[device]", WEAVE_MACHINES) {
    TestType machine;
    device_tests::OneThread one_thread;
    for (const NamedScene& named : every_scene()) {
        DeviceBench<float, TestType> bench(machine, named.scene);
        DeviceBench<float, device_tests::OneThread> alone(one_thread, named.scene);
        for (const double size : {1e-4, 0.02, 0.3}) {
            INFO(named.name << ", size " << size);
            const std::vector<float> change = some_change(bench, 5, size), left = shortened(bench, change);
            CHECK(share_of(bench, 1) >= 0.899);
            CHECK(shortened(bench, change) == left);
            if (device_tests::round_as_one_thread) CHECK(shortened(alone, change) == left);
            bool shorter = true;
            for (std::size_t i = 0; i < left.size(); ++i)
                shorter = shorter && std::abs(left[i]) <= std::abs(change[i]) && left[i] * change[i] >= 0;
            CHECK(shorter);
            if (size == 1e-4) CHECK((left == change || change.empty()));
        }
    }
}
