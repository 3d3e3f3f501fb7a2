#include <device/bench.hpp>
#include <sim/woven.hpp>

#include <weave/sim/deviation.hpp>
#include <weave/sim/device/host_machines.hpp>
#include <weave/sim/device/relax_on.hpp>

#include <catch2/catch.hpp>

#include <algorithm>

using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

struct Rest {
    RelaxResult result;
    std::vector<double> state;
};

template <class Real, class Machine>
Rest relaxed_on(Machine& machine, const SimScene& scene, const RelaxOptions& options) {
    Bench<double> bench(scene);
    Rest rest{{}, bench.state};
    rest.result = relax_on<Real>(machine, bench.energy, rest.state, options);
    return rest;
}

Rest relaxed_here(const SimScene& scene, const RelaxOptions& options) {
    Bench<double> bench(scene);
    Rest rest{{}, bench.state};
    rest.result = relax(bench.energy, rest.state, options);
    return rest;
}

double farthest(const std::vector<double>& a, const std::vector<double>& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

}  // namespace

TEST_CASE("device relaxation: comes to rest where the processor does", "[device]") {
    const SimScene scene = plain_weave({.count = 4});
    RelaxOptions options;
    options.residual = 1e-8;
    const Rest right = relaxed_here(scene, options);
    OneThreadMachine machine;
    const Rest found = relaxed_on<double>(machine, scene, options);
    CHECK(found.result.ending == Ending::converged);
    CHECK(found.result.residual <= 1e-8);
    CHECK(farthest(found.state, right.state) < 1e-4 * 0.12);
    CHECK(found.result.energy == Approx(right.result.energy).epsilon(1e-9));
    CHECK(found.result.reference_N == Approx(right.result.reference_N).epsilon(1e-6));
}
