#include <weave/sim/device/cores.hpp>
#include <weave/sim/device/emulated.hpp>

#include <catch2/catch.hpp>

#include <atomic>
#include <cstdint>
#include <numeric>
#include <vector>

using namespace weave::sim;

namespace {

template <class T>
View<T> view_of(std::vector<T>& values) {
    return {values.data(), values.size()};
}

/// What any crew must do, from `count` numbers.
template <class Crew>
void check_crew(Crew& crew, std::vector<double>& numbers, std::vector<std::uint32_t>& counts, std::vector<double>& out, bool asks) {
    const View<double> at = view_of(numbers), sums = view_of(out);
    const std::size_t count = numbers.size();
    crew.each(count, [at](std::size_t i) { at[i] = static_cast<double>(i) + 1; });
    const auto n = static_cast<double>(count);
    const double sum = crew.sum(count, [at](std::size_t i) { return at[i]; });
    const double most = crew.greatest(count, [at](std::size_t i) { return at[i]; });
    const double least = crew.least(count, [at](std::size_t i) { return -at[i]; }, 7);
    crew.sums(sums, 3, count, [at](std::size_t k, std::size_t i) { return static_cast<double>(k) * at[i]; });
    const double second = crew.read(sums, 2);
    const View<std::uint32_t> to_scan = view_of(counts);
    crew.each(count, [to_scan](std::size_t i) { to_scan[i] = static_cast<std::uint32_t>(i % 5); });
    const std::size_t total = crew.scan(to_scan, count);
    crew.in_one_block([&](auto& block) {
        const double doubled = block.sum(count, [at](std::size_t i) { return 2 * at[i]; });
        block.alone([&] { sums[3] = doubled; });
    });
    const double doubled = crew.read(sums, 3);
    crew.alone([sums] { sums[1] = 5; });
    const double told = crew.read(sums, 1);
    if (!asks) return;  // Catch is asked by one thread
    CHECK(sum == n * (n + 1) / 2);
    CHECK(most == n);
    CHECK(least == std::min(7.0, -n + (count == 0 ? 7 + n : 0)));
    CHECK(second == n * (n + 1));
    CHECK(doubled == n * (n + 1));
    CHECK(told == 5);
    std::size_t before = 0;
    bool right = true;
    for (std::size_t i = 0; i < count; ++i) {
        right = right && counts[i] == before;
        before += i % 5;
    }
    CHECK(right);
    CHECK(total == before);
}

}  // namespace

TEST_CASE("crew: every crew sums, scans and tells the same", "[device]") {
    for (const std::size_t count : {0, 1, 7, 100, 1000}) {
        std::vector<double> numbers(count), out(4);
        std::vector<std::uint32_t> counts(count);
        const Executor executor(2);
        Cores cores(executor);
        check_crew(cores, numbers, counts, out, true);
        run_alone([&](auto& gang) { check_crew(gang, numbers, counts, out, true); });
        std::atomic<int> first{0};
        emulate(2, 3, [&](auto& gang) { check_crew(gang, numbers, counts, out, first.fetch_add(1) == 0); });
    }
}
