#pragma once

#include "support/machines.hpp"

#include <weave/sim/device/crew.hpp>
#include <weave/sim/device/memory.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace {

using namespace weave::sim;

struct FillNumber {
    View<double> numbers;
    WEAVE_HD void operator()(std::size_t i) const { numbers[i] = static_cast<double>(i) + 1; }
};
struct FillCount {
    View<std::uint32_t> counts;
    WEAVE_HD void operator()(std::size_t i) const { counts[i] = static_cast<std::uint32_t>(i % 5); }
};
struct TimesNumber {
    View<const double> numbers;
    double factor;
    WEAVE_HD double operator()(std::size_t i) const { return factor * numbers[i]; }
    WEAVE_HD double operator()(std::size_t k, std::size_t i) const { return static_cast<double>(k) * numbers[i]; }
};
struct Tell {
    View<double> to;
    std::size_t at;
    double number;
    WEAVE_HD void operator()() const { to[at] = number; }
};
struct TellDoubled {
    View<const double> numbers;
    View<double> to;
    std::size_t count, at;
    template <class Crew>
    WEAVE_HD void operator()(Crew& block) const {
        const double doubled = block.sum(count, TimesNumber{numbers, 2});
        block.alone(Tell{to, at, doubled});
    }
};

/// What any crew must do; what its members return is told in `told`.
struct EveryMember {
    View<double> numbers, sums, told;
    View<std::uint32_t> counts;
    std::size_t count;

    template <class Crew>
    WEAVE_HD void operator()(Crew& crew) const {
        crew.each(count, FillNumber{numbers});
        const double sum = crew.sum(count, TimesNumber{numbers, 1});
        crew.alone(Tell{told, 0, sum});
        const double greatest = crew.greatest(count, TimesNumber{numbers, 1});
        const double least = crew.least(count, TimesNumber{numbers, -1}, 7);
        crew.alone(Tell{told, 1, greatest});
        crew.alone(Tell{told, 2, least});
        crew.sums(sums, 3, count, TimesNumber{numbers, 1});
        crew.alone(Tell{told, 3, crew.read(sums, 2)});
        crew.each(count, FillCount{counts});
        const std::size_t all = crew.scan(counts, count);
        crew.alone(Tell{told, 4, static_cast<double>(all)});
        crew.in_one_block(TellDoubled{numbers, sums, count, 3});
        crew.alone(Tell{told, 5, crew.read(sums, 3)});
        crew.alone(Tell{sums, 1, 5});
        crew.alone(Tell{told, 6, crew.read(sums, 1)});
    }
};

/// As Jacobi's method does: everything in turn from what its neighbours were before, a hundred times over.
struct Neighbours {
    View<const double> from;
    View<double> to;
    std::size_t count;
    WEAVE_HD void operator()(std::size_t i) const { to[i] = 0.5 * from[(i + 1) % count] + 0.5 * from[(i + count - 1) % count]; }
};
struct ManyTurns {
    View<double> one, other, told;
    std::size_t count, turns;

    template <class Crew>
    WEAVE_HD void operator()(Crew& crew) const {
        for (std::size_t turn = 0; turn < turns; ++turn) {
            crew.each(count, Neighbours{one, other, count});
            crew.each(count, Neighbours{other, one, count});
            const double sum = crew.sum(count, TimesNumber{one, 1});
            crew.alone(Tell{told, turn, sum});
        }
    }
};

}  // namespace

TEMPLATE_TEST_CASE("crew: sums, scans and tells like any other", "[device]", WEAVE_MACHINES) {
    for (const std::size_t count : {0, 1, 7, 100, 1000, 70'001}) {
        INFO(count);
        TestType machine;
        Array<double> numbers(machine.memory, count), sums(machine.memory, 4), told(machine.memory, 7);
        Array<std::uint32_t> counts(machine.memory, count);
        machine.run(EveryMember{numbers.view(), sums.view(), told.view(), counts.view(), count});
        const auto n = static_cast<double>(count);
        std::vector<std::uint32_t> before(count);
        std::uint32_t all = 0;
        for (std::size_t i = 0; i < count; ++i) before[i] = all, all += static_cast<std::uint32_t>(i % 5);
        const std::vector<double> right{n * (n + 1) / 2, n, count == 0 ? 7 : -n, n * (n + 1), static_cast<double>(all), n * (n + 1), 5};
        CHECK(told.get() == right);
        CHECK((counts.get() == before));
    }
}

TEMPLATE_TEST_CASE("crew: what one turn has written the next one reads, and every run gives the same", "[device]", WEAVE_MACHINES) {
    constexpr std::size_t count = 1000, turns = 50;
    std::vector<double> start(count), first;
    for (std::size_t i = 0; i < count; ++i) start[i] = 1.0 / (1 + static_cast<double>(i * i % 17));
    std::vector<double> one = start, other(count);
    for (std::size_t turn = 0; turn < 2 * turns; ++turn) {
        for (std::size_t i = 0; i < count; ++i) other[i] = 0.5 * one[(i + 1) % count] + 0.5 * one[(i + count - 1) % count];
        std::swap(one, other);
    }
    for (int run = 0; run < 3; ++run) {
        TestType machine;
        Array<double> here(machine.memory, start), there(machine.memory, count), told(machine.memory, turns);
        machine.run(ManyTurns{here.view(), there.view(), told.view(), count, turns});
        CHECK((here.get() == one));
        const std::vector<double> sums = told.get();
        if (run == 0) first = sums;
        CHECK((sums == first));
    }
}
