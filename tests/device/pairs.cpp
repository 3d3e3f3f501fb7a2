#include <device/bench.hpp>

#include <weave/sim/device/pairs.hpp>

#include <catch2/catch.hpp>

#include <deque>

using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

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

struct Store {
    HostMemory memory;
    Array<double> change{memory, places_for_pairs * numbers}, bend{memory, places_for_pairs * numbers},
        products{memory, places_for_pairs * places_for_pairs}, sums{memory, most_sums}, share{memory, most_pairs}, pivots{memory, numbers},
        gradient{memory, numbers}, trial{memory, numbers}, step{memory, numbers}, work{memory, numbers}, solved{memory, numbers},
        direction{memory, numbers};

    [[nodiscard]] PairsRoom<double> room() const {
        return {numbers, change.view(), bend.view(), products.view(), sums.view(), share.view()};
    }
};

struct DivideBy {
    View<const double> residual, pivots;
    View<double> step;

    void operator()(std::size_t i) const { step[i] = residual[i] / pivots[i]; }
};

}  // namespace

TEST_CASE("device pairs: the direction is that of the two loops", "[device]") {
    Random random(11);
    const auto some = [&] {
        Vector values(numbers);
        for (double& value : values) value = uniform(random, -1, 1);
        return values;
    };
    Store store;
    Book book{{}, Vector(numbers)};
    for (double& pivot : book.pivots) pivot = uniform(random, 0.5, 2);
    store.pivots.put(book.pivots);
    std::uint32_t count = 0, newest = 0;
    Vector gradient = some();
    for (int round = 0; round < 40; ++round) {  // the ring goes round more than twice
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
        Vector found;
        std::uint32_t count_after = 0, newest_after = 0;
        const std::uint32_t count_before = count, newest_before = newest;
        std::vector<std::uint32_t> told(2);
        const View<std::uint32_t> tell(told.data(), 2);
        by_every_crew(
            [&](auto& crew) {
                Pairs<double> pairs(store.room(), count_before, newest_before);
                pairs.remember(crew, share, store.step.view(), store.gradient.view(), store.trial.view());
                const auto apply = [&](const View<const double>& residual, const View<double>& step) {
                    crew.each(numbers, DivideBy{residual, store.pivots.view(), step});
                };
                pairs.find_direction(crew, store.trial.view(), apply, store.work.view(), store.solved.view(), store.direction.view());
                crew.alone([&] { tell[0] = pairs.count(), tell[1] = pairs.newest(); });
            },
            [&](const std::string& name) {
                INFO(name << ", round " << round);
                found = store.direction.get();
                double error = 0, size = 0;
                for (std::size_t i = 0; i < numbers; ++i) error += std::pow(found[i] - expected[i], 2), size += expected[i] * expected[i];
                CHECK(std::sqrt(error / size) < 1e-9);
                count_after = told[0], newest_after = told[1];
            });
        CHECK(count_after == book.pairs.size());
        count = count_after, newest = newest_after;
        gradient = trial;
    }
    CHECK(count == most_pairs);
}

TEST_CASE("device pairs: a step along which the energy hardly curves upwards is not kept", "[device]") {
    Store store;
    store.step.put(Vector(numbers, 1.0));
    store.gradient.put(Vector(numbers, -1.0));
    store.trial.put(Vector(numbers, -1.0 + 0.9e-3));
    Pairs<double> pairs(store.room());
    run_alone([&](auto& crew) { pairs.remember(crew, 1, store.step.view(), store.gradient.view(), store.trial.view()); });
    CHECK(pairs.count() == 0);
    store.trial.put(Vector(numbers, -1.0 + 1.1e-3));
    run_alone([&](auto& crew) { pairs.remember(crew, 1, store.step.view(), store.gradient.view(), store.trial.view()); });
    CHECK(pairs.count() == 1);
    pairs.forget();
    CHECK(pairs.count() == 0);
}
