#include <device/bench.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

/// An own sample, and how many periods away.
using Image = std::tuple<std::uint32_t, int, int>;

template <class Real>
std::vector<std::set<Image>> pairs_of(const ListsView<Real>& lists) {
    std::vector<std::set<Image>> all(lists.own);
    for (std::uint32_t a = 0; a < lists.own; ++a) {
        for (std::uint32_t e = lists.first[a]; e < lists.first[a + 1]; ++e) {
            const std::uint32_t b = lists.neighbour[e];
            const std::array<std::int16_t, 2> image = b < lists.own ? std::array<std::int16_t, 2>{} : lists.halo[b - lists.own].image;
            all[a].insert({lists.own_of(b), image[0], image[1]});
        }
        CHECK(all[a].size() == lists.first[a + 1] - lists.first[a]);
    }
    return all;
}

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
double within(const DeviceBench<double>& bench, const SamplesView<double>& samples, std::uint32_t a, const Image& image, double skin) {
    const auto [b, i, j] = image;
    const Vec<double> apart(samples.x[a] - samples.x[b] - i * bench.cloth.period_mm[0],
                            samples.y[a] - samples.y[b] - j * bench.cloth.period_mm[1], samples.z[a] - samples.z[b]);
    return samples.radius[a] + samples.radius[b] + skin - apart.norm();
}

template <class Real>
void check_lists(const SimScene& scene, double tolerance) {
    DeviceBench<Real> bench(scene);
    DeviceBench<double> exact(scene);
    bench.host.evaluate();
    Neighbours<double>& right = bench.host.energy.neighbours();
    const std::vector<std::set<Image>> expected = pairs_of(right, bench.cloth.samples);
    const ListsView<Real> lists = bench.listed().view();
    const std::vector<std::set<Image>> found = pairs_of(lists);
    std::size_t wrong = 0, doubtful = 0;
    for (std::uint32_t a = 0; a < found.size(); ++a) {
        std::vector<Image> differ;
        std::ranges::set_symmetric_difference(found[a], expected[a], std::back_inserter(differ));
        for (const Image& image : differ)
            ++(std::abs(within(exact, right.samples(), a, image, right.skin_mm())) > tolerance ? wrong : doubtful);
    }
    CHECK(wrong == 0);
    CHECK(doubtful <= right.entries() / 1000 + 4);
}

}  // namespace

TEST_CASE("device lists: the pairs that the processor lists", "[device]") {
    for (const NamedScene& named : every_scene()) {
        INFO(named.name);
        check_lists<double>(named.scene, 1e-9);
        check_lists<float>(named.scene, 2e-6);
    }
}

TEST_CASE("device lists: every crew makes the same", "[device]") {
    for (const NamedScene& named : every_scene()) {
        INFO(named.name);
        DeviceBench<float> bench(named.scene);
        bench.listed();
        std::vector<std::uint32_t> first, neighbours;
        by_every_crew(
            [&](auto& crew) {
                Lists<float> made(bench.cloth, bench.lists.room(), {});
                made.update(crew, bench.at());
            },
            [&](const std::string& name) {
                INFO(name);
                const ListsRoom<float>& room = bench.lists.room();
                std::vector<std::uint32_t> first_now, now;
                for (std::size_t a = 0; a <= bench.cloth.samples; ++a) first_now.push_back(room.first[a]);
                for (std::size_t e = 0; e < first_now.back(); ++e) now.push_back(room.neighbour[e]);
                if (first.empty()) first = first_now, neighbours = now;
                CHECK(first == first_now);
                CHECK(neighbours == now);
            });
    }
}

TEST_CASE("device lists: what does not fit is told, and fits once room was made", "[device]") {
    const SimScene scene = plain_weave({.count = 4});
    DeviceBench<double> bench(scene);
    Lists<double> whole = bench.listed();
    const std::size_t all = whole.view().first[bench.cloth.samples];
    ListsRoom<double> small = bench.lists.room();
    small.neighbours = all - 1;
    Lists<double> cut(bench.cloth, small, {});
    bool done = true;
    run_alone([&](auto& crew) { done = cut.update(crew, bench.at()); });
    CHECK_FALSE(done);
    CHECK(cut.state().needs_neighbours == all);
    CHECK_FALSE(cut.state().made);
    small.neighbours = all;
    Lists<double> again(bench.cloth, small, cut.state());
    run_alone([&](auto& crew) { done = again.update(crew, bench.at()); });
    CHECK(done);
    for (std::size_t* room : {&small.images, &small.candidates}) {
        const std::size_t before = std::exchange(*room, 1);
        Lists<double> none(bench.cloth, small, {});
        run_alone([&](auto& crew) { done = none.update(crew, bench.at()); });
        CHECK_FALSE(done);
        ListsState needs = none.state();
        CHECK(std::max(needs.needs_images, needs.needs_candidates) > 1);
        *room = before;
    }
    // From room for next to nothing to all of it, by what was told.
    DeviceBench<double> grown(scene);
    grown.lists_state.needs_images = grown.lists_state.needs_neighbours = grown.lists_state.needs_candidates = 1;
    grown.lists.grow(grown.lists_state);
    CHECK(pairs_of(grown.listed().view()) == pairs_of(whole.view()));
}

TEST_CASE("device lists: they hold until a sample has gone half the skin", "[device]") {
    DeviceBench<double> bench(plain_weave({.count = 4}));
    CHECK(bench.listed().state().builds == 1);
    const double skin = bench.listed().skin_mm();
    std::vector<double> moved = bench.host.state;
    const auto go = [&](double way) {
        for (std::size_t i = 2; i < moved.size(); i += 3) moved[i] = bench.host.state[i] + way;
        bench.state.put(moved);
        return bench.listed().state().builds;
    };
    CHECK(go(0.49 * skin) == 1);
    CHECK(go(0.51 * skin) == 2);
    CHECK(go(0.51 * skin) == 2);
    CHECK(go(3 * skin) == 3);  // beyond the wide list as well
}
