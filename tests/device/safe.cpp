#include <device/bench.hpp>

#include <catch2/catch.hpp>

#include <algorithm>

using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

/// A change of the rows at random, as large as the radius.
template <class Real>
std::vector<Real> some_change(const DeviceBench<Real>& bench, std::uint64_t seed, double size) {
    Random random(seed);
    std::vector<Real> change(3 * std::size_t(bench.cloth.rows));
    for (Real& part : change) part = static_cast<Real>(uniform(random, -size, size));
    return change;
}

template <class Real>
double share_of(DeviceBench<Real>& bench, double most) {
    const Lists<Real> lists = bench.listed();
    double share = 0;
    run_alone([&](auto& crew) { share = bench.safe().safe_share(crew, lists.view(), bench.at(), bench.change.view(), most); });
    return share;
}

template <class Real>
void check_share(const SimScene& scene, double size, double tolerance) {
    DeviceBench<Real> bench(scene);
    bench.host.evaluate();
    const std::vector<Real> change = some_change(bench, 3, size);
    bench.change.put(change);
    const double right = bench.host.energy.safe_share(bench.host.state, bench.slots_of(change), 8);
    CHECK(share_of(bench, 8) == Approx(right).epsilon(tolerance));
}

}  // namespace

TEST_CASE("device steps: what is safe is what the processor holds for safe", "[device]") {
    for (const NamedScene& named : every_scene()) {
        INFO(named.name);
        for (const double size : {1e-4, 0.05, 1.0}) {
            check_share<double>(named.scene, size, 1e-9);
            check_share<float>(named.scene, size, 1e-3);
        }
    }
}

TEST_CASE("device steps: what is left of a shortened change is safe, and goes on where it was", "[device]") {
    for (const NamedScene& named : every_scene()) {
        INFO(named.name);
        DeviceBench<float> bench(named.scene);
        const Lists<float> lists = bench.listed();
        for (const double size : {1e-4, 0.02, 0.3}) {
            const std::vector<float> change = some_change(bench, 5, size);
            std::vector<float> first;
            by_every_crew(
                [&](auto& crew) {
                    crew.alone([&] { bench.change.put(change); });
                    bench.safe().shorten(crew, lists.view(), bench.at(), bench.change.view());
                },
                [&](const std::string& name) {
                    INFO(name << ", size " << size);
                    const std::vector<float> left = bench.change.get();
                    if (first.empty()) first = left;
                    CHECK(left == first);
                    CHECK(share_of(bench, 1) >= 0.899);
                    bool shorter = true;
                    for (std::size_t i = 0; i < left.size(); ++i)
                        shorter = shorter && std::abs(left[i]) <= std::abs(change[i]) && left[i] * change[i] >= 0;
                    CHECK(shorter);
                    if (size == 1e-4) CHECK((left == change || change.empty()));
                });
        }
    }
}
