#pragma once

#include "support/machines.hpp"
#include "support/told.hpp"

#include <weave/sim/device/memory.hpp>
#include <weave/sim/device/pairs.hpp>

#include <sim/scenes.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

namespace {

using namespace weave::sim;
using namespace weave::sim::testing;

constexpr std::size_t numbers = 30;

using Vector = std::vector<double>;

double product(const Vector& a, const Vector& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

/// The two loops as the book has them.
struct Book {
    std::deque<std::pair<Vector, Vector>> pairs;
    Vector pivots;

    [[nodiscard]] Vector solved(const Vector& residual) const {
        Vector step = residual;
        for (std::size_t i = 0; i < numbers; ++i) step[i] /= pivots[i];
        return step;
    }
    void remember(const Vector& change, const Vector& bend) {
        pairs.emplace_back(change, bend);
        if (pairs.size() > most_pairs) pairs.pop_front();
    }
    [[nodiscard]] Vector direction(const Vector& gradient) const {
        Vector left = gradient, share(pairs.size());
        for (std::size_t p = pairs.size(); p-- > 0;) {
            share[p] = product(pairs[p].first, left) / product(pairs[p].first, pairs[p].second);
            for (std::size_t i = 0; i < numbers; ++i) left[i] -= share[p] * pairs[p].second[i];
        }
        Vector way = solved(left);
        if (!pairs.empty()) {
            const auto& [change, bend] = pairs.back();
            for (double& part : way) part *= product(change, bend) / product(bend, solved(bend));
        }
        for (std::size_t p = 0; p < pairs.size(); ++p) {
            const double less = share[p] - product(pairs[p].second, way) / product(pairs[p].first, pairs[p].second);
            for (std::size_t i = 0; i < numbers; ++i) way[i] += less * pairs[p].first[i];
        }
        for (double& part : way) part = -part;
        return way;
    }
};

/// Which pairs there are.
struct PairsTold {
    std::uint32_t count, newest;
};

struct Store {
    Memory& memory;
    Array<double> change{memory, places_for_pairs * numbers}, bend{memory, places_for_pairs * numbers},
        products{memory, places_for_pairs * places_for_pairs}, sums{memory, most_sums}, share{memory, most_pairs}, pivots{memory, numbers},
        gradient{memory, numbers}, trial{memory, numbers}, step{memory, numbers}, work{memory, numbers}, solved{memory, numbers},
        direction{memory, numbers};
    Array<PairsTold> told{memory, 1};

    explicit Store(Memory& in) : memory(in) {}

    [[nodiscard]] PairsRoom<double> room() const {
        return {numbers, change.view(), bend.view(), products.view(), sums.view(), share.view()};
    }
};

struct DivideBy {
    View<const double> residual, pivots;
    View<double> step;

    WEAVE_HD void operator()(std::size_t i) const { step[i] = residual[i] / pivots[i]; }
};

/// A preconditioner.
template <class Crew>
struct DivideAll {
    Crew& crew;
    View<const double> pivots;

    WEAVE_HD void operator()(const View<const double>& residual, const View<double>& step) const {
        crew.each(numbers, DivideBy{residual, pivots, step});
    }
};

/// Remembers a step from what the store holds of it.
struct RememberStep {
    PairsRoom<double> room;
    PairsTold before;
    double share;
    View<const double> step, gradient, trial;
    View<PairsTold> told;

    template <class Crew>
    WEAVE_HD void operator()(Crew& crew) const {
        Pairs<double> pairs(room, before.count, before.newest);
        pairs.remember(crew, share, step, gradient, trial);
        crew.alone(device_tests::TellIt<PairsTold>{told, {pairs.count(), pairs.newest()}});
    }
};

/// The same, and the direction from there on.
struct RememberAndFind {
    RememberStep remember;
    View<const double> pivots;
    View<double> work, solved, direction;

    template <class Crew>
    WEAVE_HD void operator()(Crew& crew) const {
        Pairs<double> pairs(remember.room, remember.before.count, remember.before.newest);
        pairs.remember(crew, remember.share, remember.step, remember.gradient, remember.trial);
        DivideAll<Crew> apply{crew, pivots};
        pairs.find_direction(crew, remember.trial, apply, work, solved, direction);
        crew.alone(device_tests::TellIt<PairsTold>{remember.told, {pairs.count(), pairs.newest()}});
    }
};

RememberStep remember(const Store& store, const PairsTold& before, double share) {
    return {store.room(), before, share, store.step.view(), store.gradient.view(), store.trial.view(), store.told.view()};
}

}  // namespace

TEMPLATE_TEST_CASE("pairs: the direction is that of the two loops", "[device]", WEAVE_MACHINES) {
    Random random(11);
    const auto some = [&] {
        Vector values(numbers);
        for (double& value : values) value = uniform(random, -1, 1);
        return values;
    };
    TestType machine;
    Store store(machine.memory);
    Book book{{}, Vector(numbers)};
    for (double& pivot : book.pivots) pivot = uniform(random, 0.5, 2);
    store.pivots.put(book.pivots);
    PairsTold told{0, 0};
    Vector gradient = some();
    for (int round = 0; round < 40; ++round) {  // the ring goes round more than twice
        INFO("round " << round);
        const Vector change = some();
        Vector trial = gradient;
        const double share = 0.7;
        for (std::size_t i = 0; i < numbers; ++i) trial[i] += share * change[i] * (1 + 0.1 * static_cast<double>(i)) + 0.01 * change[numbers - 1 - i];
        Vector bend(numbers), scaled(numbers);
        for (std::size_t i = 0; i < numbers; ++i) bend[i] = trial[i] - gradient[i], scaled[i] = share * change[i];
        const bool curves = product(scaled, bend) > 1e-3 * std::abs(product(scaled, gradient));
        if (curves) book.remember(scaled, bend);
        store.step.put(change);
        store.gradient.put(gradient);
        store.trial.put(trial);
        const Vector expected = book.direction(trial);
        machine.run(RememberAndFind{remember(store, told, share), store.pivots.view(), store.work.view(), store.solved.view(),
                                    store.direction.view()});
        const Vector found = store.direction.get();
        double error = 0, size = 0;
        for (std::size_t i = 0; i < numbers; ++i) error += std::pow(found[i] - expected[i], 2), size += expected[i] * expected[i];
        CHECK(std::sqrt(error / size) < 1e-9);
        told = store.told.get().front();
        CHECK(told.count == book.pairs.size());
        gradient = trial;
    }
    CHECK(told.count == most_pairs);
}

TEMPLATE_TEST_CASE("pairs: a step along which the energy hardly curves upwards is not kept", "[device]", WEAVE_MACHINES) {
    TestType machine;
    Store store(machine.memory);
    const auto count_after = [&](double trial, const PairsTold& before) {
        store.trial.put(Vector(numbers, trial));
        machine.run(remember(store, before, 1));
        return store.told.get().front().count;
    };
    store.step.put(Vector(numbers, 1.0));
    store.gradient.put(Vector(numbers, -1.0));
    CHECK(count_after(-1.0 + 0.9e-3, {0, 0}) == 0);
    CHECK(count_after(-1.0 + 1.1e-3, {0, 0}) == 1);
    Pairs<double> pairs(store.room(), 1, store.told.get().front().newest);
    CHECK(pairs.count() == 1);
    pairs.forget();
    CHECK(pairs.count() == 0);
}
