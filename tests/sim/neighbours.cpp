#include "scenes.hpp"

#include <weave/sim/neighbours.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <set>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

/// A sample and which of its images, in periods.
using Image = std::array<std::int64_t, 3>;

/// Who stands in the list of a sample. One who stands there twice fails the test.
std::set<Image> listed(Bench<double>& bench, std::size_t sample) {
    Neighbours<double>& neighbours = bench.energy.neighbours();
    const SamplesView<double> all = neighbours.samples();
    const SimScene& scene = bench.fabric.scene();
    std::set<Image> found;
    for (std::uint32_t e = neighbours.first()[sample]; e < neighbours.first()[sample + 1]; ++e) {
        const std::uint32_t other = neighbours.others()[e], own = neighbours.own(other);
        const auto periods = [&](double moved, std::size_t axis) {
            return scene.is_periodic[axis] ? std::llround(moved / scene.period_mm[axis]) : 0LL;
        };
        const Image image{own, periods(all.x[other] - all.x[own], 0), periods(all.y[other] - all.y[own], 1)};
        CHECK(found.insert(image).second);
    }
    return found;
}

/// Whether image (i, j) of sample b lies within half a turn of sample a along the same strand.
bool same_stretch(Bench<double>& bench, std::size_t a, std::size_t b, std::int64_t i, std::int64_t j) {
    Neighbours<double>& neighbours = bench.energy.neighbours();
    const auto yarn_of = [&](std::size_t sample) {
        return bench.fabric.segment_places()[neighbours.segment_of(static_cast<std::uint32_t>(sample))].yarn;
    };
    if (yarn_of(a) != yarn_of(b)) return false;
    const SimYarn& yarn = bench.fabric.scene().yarns[yarn_of(a)];
    const YarnConstants<double>& constants = bench.fabric.constants()[yarn_of(a)];
    const auto samples =
        static_cast<std::int64_t>(bench.fabric.yarns()[yarn_of(a)].segments * constants.samples);
    const double step =
        (neighbours.samples().weight[a] + neighbours.samples().weight[b]) / (2 * constants.root_k);
    for (std::int64_t turn = -80; turn <= 80; ++turn) {
        if (!yarn.is_periodic && turn != 0) continue;
        if (i != turn * yarn.turns[0] || j != turn * yarn.turns[1]) continue;
        const std::int64_t apart =
            static_cast<std::int64_t>(b) - static_cast<std::int64_t>(a) + turn * samples;
        if (static_cast<double>(std::abs(apart)) * step < std::numbers::pi * yarn.radius_mm) return true;
    }
    return false;
}

/// Who ought to stand there, by trying everything.
std::set<Image> by_force(Bench<double>& bench, std::size_t a) {
    Neighbours<double>& neighbours = bench.energy.neighbours();
    const SamplesView<double> all = neighbours.samples();
    const SimScene& scene = bench.fabric.scene();
    const auto images = [&](std::size_t axis) {
        return scene.is_periodic[axis] ? static_cast<int>(std::ceil(4 / scene.period_mm[axis])) : 0;
    };
    const int far_x = images(0), far_y = images(1);
    std::set<Image> found;
    for (std::size_t b = 0; b < bench.fabric.samples(); ++b) {
        const double reach = all.radius[a] + all.radius[b] + neighbours.skin_mm();
        for (int i = -far_x; i <= far_x; ++i) {
            for (int j = -far_y; j <= far_y; ++j) {
                const Vec3 apart(all.x[b] + i * scene.period_mm[0] - all.x[a],
                                 all.y[b] + j * scene.period_mm[1] - all.y[a], all.z[b] - all.z[a]);
                if (apart.norm() >= reach || (a == b && i == 0 && j == 0)) continue;
                if (!same_stretch(bench, a, b, i, j)) found.insert({static_cast<std::int64_t>(b), i, j});
            }
        }
    }
    return found;
}

void check_neighbours(const SimScene& scene) {
    Bench bench(scene);
    bench.evaluate();
    std::size_t entries = 0;
    for (std::size_t a = 0; a < bench.fabric.samples(); ++a) {
        const std::set<Image> wanted = by_force(bench, a);
        entries += wanted.size();
        if (listed(bench, a) != wanted) FAIL_CHECK("sample " << a << " has other neighbours than it should");
    }
    CHECK(bench.energy.neighbours().entries() == entries);
    CHECK(bench.energy.neighbours().holds());
}

/// Yarns anywhere in a box; radii from `least` to `most`.
SimScene tangle(Random& random, std::size_t yarns, double least, double most, std::array<double, 2> period) {
    SimScene scene;
    scene.period_mm = period;
    scene.is_periodic = {period[0] > 0, period[1] > 0};
    for (std::size_t y = 0; y < yarns; ++y) {
        const double radius = least * std::pow(most / least, uniform(random, 0, 1));
        const std::array<int, 2> turns{scene.is_periodic[0] && random.coin() ? 1 : 0,
                                       scene.is_periodic[1] && random.coin() ? 1 : 0};
        const bool is_periodic = turns[0] != 0 || turns[1] != 0;
        const Vec3 along =
            is_periodic ? Vec3(turns[0] * period[0], turns[1] * period[1], 0) : jitter(random, 1);
        const Vec3 from = jitter(random, 0.3);
        SimYarn yarn = laid(usual_yarn(radius), from, from + along, random.between(2, 6), is_periodic);
        yarn.turns = turns;
        shake(random, yarn, 0.1);
        scene.yarns.push_back(yarn);
    }
    return scene;
}

}  // namespace

TEST_CASE("neighbours are those that trying every pair finds") {
    weave::testing::for_all(
        [](Random& random) {
            const std::array<double, 2> period{random.coin() ? uniform(random, 0.6, 1.5) : 0,
                                               random.coin() ? uniform(random, 0.6, 1.5) : 0};
            check_neighbours(tangle(random, random.between(1, 5), 0.1, 0.3, period));
        },
        30);
}

TEST_CASE("neighbours are right where periods are far shorter than yarns are thick") {
    weave::testing::for_all(
        [](Random& random) {
            check_neighbours(
                tangle(random, random.between(1, 2), 0.1, 0.15, {0.8, uniform(random, 0.05, 0.2)}));
        },
        10);
}

TEST_CASE("neighbours are right where one yarn is a hundred times as thick as another") {
    weave::testing::for_all(
        [](Random& random) {
            SimScene scene = tangle(random, random.between(2, 4), 0.01, 1, {0, 0});
            scene.yarns[0].radius_mm = 1;
            scene.yarns[1].radius_mm = 0.01;
            check_neighbours(scene);
        },
        5);
}

TEST_CASE("every pair stands in both lists, and goes on standing there until the list is made anew") {
    weave::testing::for_all(
        [](Random& random) {
            Bench bench(tangle(random, 4, 0.1, 0.3, {1.1, 0}));
            bench.evaluate();
            const double skin = bench.energy.neighbours().skin_mm();
            for (int move = 0; move < 6; ++move) {
                const std::size_t builds = bench.energy.neighbours().builds();
                for (std::size_t i = 0; i < bench.state.size(); ++i)
                    bench.state[i] += uniform(random, -0.15, 0.15) * skin;
                bench.fabric.follow(bench.state);
                bench.evaluate();
                for (std::size_t a = 0; a < bench.fabric.samples(); ++a) {
                    const std::set<Image> mine = listed(bench, a);
                    for (const Image& other : mine) {
                        const Image back{static_cast<std::int64_t>(a), -other[1], -other[2]};
                        if (!listed(bench, static_cast<std::size_t>(other[0])).contains(back))
                            FAIL_CHECK("sample " << a << " is no neighbour of its neighbour");
                    }
                }
                if (bench.energy.neighbours().builds() == builds) CHECK(bench.energy.neighbours().holds());
                // What touches is found, however old the list is: far away and back makes a new one.
                const double energy = bench.evaluate();
                Bench anew(bench.fabric.scene());
                anew.evaluate();
                for (const std::size_t far : {std::size_t{9}, std::size_t{0}}) {
                    anew.state = bench.state;
                    for (std::size_t i = 2; i < anew.state.size(); i += 3)
                        anew.state[i] += static_cast<double>(far);
                    CHECK(anew.evaluate() == Approx(energy).epsilon(1e-12));
                }
                CHECK(anew.energy.neighbours().builds() == 3);
            }
        },
        20);
}

TEST_CASE("a yarn does not touch itself within half a turn along it, but beyond") {
    // A hairpin of two straight legs, 1.5 radii apart; its turn is wider than that, so only legs can touch.
    SimScene scene;
    SimYarn yarn = usual_yarn(0.1);
    for (int i = 0; i <= 20; ++i) yarn.control.emplace_back(0.1 * i, 0, 0);
    for (int i = 20; i >= 0; --i) yarn.control.emplace_back(0.1 * i, 0.15, 0);
    yarn.rest_mm = 4.1;
    scene.yarns = {yarn};
    Bench bench(scene);
    bench.evaluate({.elastic = false});
    CHECK(bench.gradient[bench.at(0, 5) + 1] > 0.1);    // one leg is pushed down,
    CHECK(bench.gradient[bench.at(0, 36) + 1] < -0.1);  // the other up

    scene.yarns[0].control.resize(21);  // one leg alone touches nothing
    scene.yarns[0].rest_mm = 2;
    Bench straight(scene);
    CHECK(straight.evaluate({.elastic = false}) == 0);
    CHECK(straight.energy.neighbours().entries() == 0);
}

TEST_CASE("a straight periodic yarn is no neighbour of its own way on, but of the strand beside it") {
    SimScene scene;
    scene.is_periodic = {true, true};
    scene.period_mm = {0.3, 10};  // shorter than half a turn of the yarn
    SimYarn yarn = laid(usual_yarn(0.12), {0, 0, 0}, {0.3, 0, 0}, 4, true);
    yarn.turns = {1, 0};
    scene.yarns = {yarn};
    Bench alone(scene);
    CHECK(alone.evaluate({.elastic = false}) == 0);
    CHECK(alone.energy.neighbours().entries() == 0);
    scene.period_mm[1] = 0.2;
    Bench beside(scene);
    CHECK(beside.evaluate({.elastic = false}) > 0);
}
