#pragma once

#include "bench.hpp"
#include "support/machines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace {

using namespace weave::sim;
using namespace weave::sim::testing;

/// An own sample, and how many periods away.
using Image = std::tuple<std::uint32_t, int, int>;

/// Lists as a machine has made them.
struct ListsHere {
    std::uint32_t own = 0;
    std::vector<HaloSample> halo;
    std::vector<std::uint32_t> first, neighbour;

    template <class Real, class Machine>
    static ListsHere of(DeviceBench<Real, Machine>& bench) {
        const ListsView<Real> lists = bench.listed();
        weave::sim::Memory& memory = bench.machine.memory;
        ListsHere here{lists.own, device_tests::fetched(memory, lists.halo, bench.lists_state.halo),
                       device_tests::fetched(memory, lists.first, lists.own + std::size_t{1}), {}};
        here.neighbour = device_tests::fetched(memory, lists.neighbour, here.first.back());
        return here;
    }

    [[nodiscard]] std::vector<std::set<Image>> pairs() const {
        std::vector<std::set<Image>> all(own);
        for (std::uint32_t a = 0; a < own; ++a) {
            for (std::uint32_t e = first[a]; e < first[a + 1]; ++e) {
                const std::uint32_t b = neighbour[e];
                if (b < own) all[a].insert({b, 0, 0});
                else all[a].insert({halo.at(b - own).of, halo[b - own].image[0], halo[b - own].image[1]});
            }
            CHECK(all[a].size() == first[a + 1] - first[a]);
        }
        return all;
    }
};

std::vector<std::set<Image>> pairs_of(Neighbours<double>& lists, std::size_t samples) {
    std::vector<std::set<Image>> all(samples);
    for (std::uint32_t a = 0; a < samples; ++a) {
        for (std::uint32_t e = lists.first()[a]; e < lists.first()[a + 1]; ++e) {
            const std::uint32_t b = lists.others()[e];
            all[a].insert({lists.own(b), lists.image(b)[0], lists.image(b)[1]});
        }
    }
    return all;
}

/// By how far a pair lies within the limit of the lists, mm.
double within(const double (&period_mm)[2], const SamplesView<double>& samples, std::uint32_t a, const Image& image, double skin) {
    const auto [b, i, j] = image;
    const Vec<double> apart(samples.x[a] - samples.x[b] - i * period_mm[0], samples.y[a] - samples.y[b] - j * period_mm[1],
                            samples.z[a] - samples.z[b]);
    return samples.radius[a] + samples.radius[b] + skin - apart.norm();
}

template <class Real, class Machine>
void check_lists(Machine& machine, const SimScene& scene, double tolerance) {
    DeviceBench<Real, Machine> bench(machine, scene);
    bench.host.evaluate();
    Neighbours<double>& right = bench.host.energy.neighbours();
    const std::vector<std::set<Image>> expected = pairs_of(right, bench.cloth.samples), found = ListsHere::of(bench).pairs();
    std::size_t wrong = 0, doubtful = 0;
    for (std::uint32_t a = 0; a < found.size(); ++a) {
        std::vector<Image> differ;
        std::ranges::set_symmetric_difference(found[a], expected[a], std::back_inserter(differ));
        for (const Image& image : differ)
            ++(std::abs(within(bench.cloth.period_mm, right.samples(), a, image, right.skin_mm())) > tolerance ? wrong : doubtful);
    }
    CHECK(wrong == 0);
    CHECK(doubtful <= right.entries() / 1000 + 4);
}

}  // namespace

TEMPLATE_TEST_CASE("lists: the pairs that the processor lists", "[device]", WEAVE_MACHINES) {
    TestType machine;
    for (const NamedScene& named : every_scene()) {
        INFO(named.name);
        check_lists<double>(machine, named.scene, 1e-9);
        check_lists<float>(machine, named.scene, 2e-6);
    }
}

TEMPLATE_TEST_CASE("lists: every time the same, on the processor those of one thread", "[device]", WEAVE_MACHINES) {
    TestType machine;
    device_tests::OneThread alone;
    for (const NamedScene& named : every_scene()) {
        INFO(named.name);
        DeviceBench<float, TestType> bench(machine, named.scene), anew(machine, named.scene);
        DeviceBench<float, device_tests::OneThread> right(alone, named.scene);
        const ListsHere found = ListsHere::of(bench), again = ListsHere::of(anew), expected = ListsHere::of(right);
        CHECK(found.first == again.first);
        CHECK(found.neighbour == again.neighbour);
        if (!device_tests::round_as_one_thread) continue;
        CHECK(found.first == expected.first);
        CHECK(found.neighbour == expected.neighbour);
    }
}

TEMPLATE_TEST_CASE("lists: what does not fit is told, and fits once room was made", "[device]", WEAVE_MACHINES) {
    TestType machine;
    const SimScene scene = plain_weave({.count = 4});
    DeviceBench<double, TestType> bench(machine, scene);
    const ListsHere whole = ListsHere::of(bench);
    const std::size_t all = whole.first.back();
    ListsRoom<double> small = bench.lists.room();
    small.neighbours = all - 1;
    const ListsTold cut = bench.update(small, {});
    CHECK_FALSE(cut.done);
    CHECK(cut.state.needs_neighbours == all);
    CHECK_FALSE(cut.state.made);
    small.neighbours = all;
    CHECK(bench.update(small, cut.state).done);
    for (std::size_t* room : {&small.images, &small.candidates}) {
        const std::size_t before = std::exchange(*room, 1);
        const ListsTold none = bench.update(small, {});
        CHECK_FALSE(none.done);
        CHECK(std::max(none.state.needs_images, none.state.needs_candidates) > 1);
        *room = before;
    }
    // From room for next to nothing to all of it, by what was told.
    DeviceBench<double, TestType> grown(machine, scene);
    grown.lists_state.needs_images = grown.lists_state.needs_neighbours = grown.lists_state.needs_candidates = 1;
    grown.lists.grow(grown.lists_state);
    CHECK(ListsHere::of(grown).pairs() == whole.pairs());
}

TEMPLATE_TEST_CASE("lists: they hold until a sample has gone half the skin", "[device]", WEAVE_MACHINES) {
    TestType machine;
    DeviceBench<double, TestType> bench(machine, plain_weave({.count = 4}));
    bench.listed();
    CHECK(bench.lists_state.builds == 1);
    const double skin = Lists<double>(bench.cloth, bench.lists.room(), bench.lists_state).skin_mm();
    std::vector<double> moved = bench.host.state;
    const auto go = [&](double way) {
        for (std::size_t i = 2; i < moved.size(); i += 3) moved[i] = bench.host.state[i] + way;
        bench.state.put(moved);
        bench.listed();
        return bench.lists_state.builds;
    };
    CHECK(go(0.49 * skin) == 1);
    CHECK(go(0.51 * skin) == 2);
    CHECK(go(0.51 * skin) == 2);
    CHECK(go(3 * skin) == 3);  // beyond the wide list as well
}
