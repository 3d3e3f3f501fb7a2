#include <device/bench.hpp>

#include <catch2/catch.hpp>

#include <algorithm>

using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

template <class Real>
double pull_alone(DeviceBench<Real>& bench, Real give, Terms terms) {
    const Lists<Real> lists = bench.listed();
    double energy = 0;
    run_alone([&](auto& crew) { energy = pull(crew, bench.cloth, lists.view(), bench.forces(), bench.at(), give, terms, bench.gradient.view()); });
    return energy;
}

/// Energy and forces against the processor's, errors as shares of the greatest force and of the energy of all terms.
template <class Real>
void check_forces(const SimScene& scene, Terms terms, double give, double tolerance) {
    DeviceBench<Real> bench(scene);
    bench.host.energy.give_beyond(give);
    const double right = bench.host.evaluate(terms), energy = pull_alone(bench, static_cast<Real>(give), terms);
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

TEST_CASE("device forces: energy and gradient are the processor's", "[device]") {
    for (const NamedScene& named : every_scene()) {
        INFO(named.name);
        for (const Terms terms : {Terms{true, true}, Terms{true, false}, Terms{false, true}}) {
            for (const double give : {1e300, 0.01}) {
                INFO("elastic " << terms.elastic << ", contact " << terms.contact << ", gives beyond " << give);
                check_forces<double>(named.scene, terms, give, 2e-10 * named.rounding);
                check_forces<float>(named.scene, terms, std::min(give, 1e30), 2e-5);
            }
        }
    }
}

TEST_CASE("device forces: every crew pulls the same", "[device]") {
    for (const NamedScene& named : every_scene()) {
        INFO(named.name);
        DeviceBench<float> bench(named.scene);
        const double alone = pull_alone(bench, 1e30F, {});
        const std::vector<float> expected = bench.gradient.get();
        const Lists<float> lists = bench.listed();
        std::vector<double> energies(1);
        const View<double> told(energies.data(), 1);
        by_every_crew(
            [&](auto& crew) {
                const double energy = pull(crew, bench.cloth, lists.view(), bench.forces(), bench.at(), 1e30F, {}, bench.gradient.view());
                crew.alone([&] { told[0] = energy; });
            },
            [&](const std::string& name) {
                INFO(name);
                CHECK(bench.gradient.get() == expected);
                CHECK(energies[0] == Approx(alone).epsilon(1e-12));
            });
    }
}
