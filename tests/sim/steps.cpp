// How far yarns may be moved at once.

#include "scenes.hpp"

#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

/// A change of state that moves what may move by up to `size`.
std::vector<double> random_change(Random& random, const Bench<double>& bench, double size) {
    std::vector<double> change(bench.state.size(), 0.0);
    for (std::size_t slot = 0; slot < bench.fabric.slots(); ++slot) {
        if (bench.fabric.moves()[slot] == 0) continue;
        const Vec3 by = jitter(random, size);
        for (std::size_t k = 0; k < 3; ++k) change[3 * slot + k] = by[static_cast<Eigen::Index>(k)];
    }
    bench.fabric.follow_change(change);
    return change;
}

std::vector<Vec3> sample_places(Bench<double>& bench) {
    const SamplesView<double> all = bench.energy.neighbours().samples();
    std::vector<Vec3> places;
    for (std::size_t s = 0; s < bench.fabric.samples() + bench.energy.neighbours().halo(); ++s)
        places.emplace_back(all.x[s], all.y[s], all.z[s]);
    return places;
}

/// Samples of another yarn: how far apart they are, and how far one moves towards the other.
struct Worst {
    double pair = 0;      ///< greatest change of a pair's difference, as a share of its distance
    double movement = 0;  ///< of a sample, mm
    double lines =
        0;  ///< the same as pair, of the straight lines through samples that lie deep in one another
    bool crushed = false;  ///< such lines come closer that are nearer than a fiftieth of the reach
};

/// What a whole change does to the lines through two samples: how far they come closer, as a share of their
/// distance.
void look_at_lines(const Vec3& apart, const Vec3& change, const Vec3& along, const Vec3& other, double reach,
                   double share, Worst& worst) {
    if (apart.norm() >= reach / 2 || std::min(along.norm(), other.norm()) < 0.1 * reach) return;
    Vec3 across = along.normalized().cross(other.normalized());
    if (across.norm() < 0.1) {
        const Vec3 both = along.normalized() + other.normalized() * (along.dot(other) < 0 ? -1 : 1);
        across = apart - both * both.dot(apart) / both.squaredNorm();
    }
    if (across.norm() == 0) return;
    across.normalize();
    const double height = apart.dot(across), closer = -change.dot(across) * (height > 0 ? 1 : -1);
    if ((apart - height * across).norm() >= 0.3 * reach || closer <= 0) return;
    worst.lines = std::max(worst.lines, share * closer / std::abs(height));
    worst.crushed = worst.crushed || std::abs(height) < 0.02 * reach;
}

/// What a change does to every pair of samples of two yarns that come within reach, images included.
Worst worst_of(Bench<double>& bench, const std::vector<double>& change, double share) {
    bench.evaluate();
    Neighbours<double>& neighbours = bench.energy.neighbours();
    const std::vector<Vec3> before = sample_places(bench);
    std::vector<std::vector<std::uint32_t>> near(bench.fabric.samples());
    for (std::size_t a = 0; a < near.size(); ++a)
        near[a].assign(neighbours.others() + neighbours.first()[a],
                       neighbours.others() + neighbours.first()[a + 1]);
    std::vector<Vec3> moved(bench.fabric.samples()), along(bench.fabric.samples());
    for (std::size_t s = 0; s < bench.fabric.segments(); ++s) {
        const SegmentPlace& place = bench.fabric.segment_places()[s];
        const YarnConstants<double>& yarn = bench.fabric.constants()[place.yarn];
        for (std::uint32_t k = 0; k < yarn.samples; ++k) {
            const Basis<double>& basis = bench.fabric.bases()[yarn.basis + k];
            moved[place.sample + k] = combine(basis.value, &change[3 * std::size_t(place.slot)]);
            along[place.sample + k] = combine(basis.slope, &bench.state[3 * std::size_t(place.slot)]);
        }
    }
    const SamplesView<double> all = neighbours.samples();
    Worst worst;
    for (std::size_t a = 0; a < near.size(); ++a) {
        worst.movement = std::max(worst.movement, share * moved[a].norm());
        for (const std::uint32_t b : near[a]) {
            const std::uint32_t own = neighbours.own(b);
            const Vec3 apart = before[a] - before[b], closing = moved[a] - moved[own];
            worst.pair = std::max(worst.pair, share * closing.norm() / apart.norm());
            look_at_lines(apart, closing, along[a], along[own], all.radius[a] + all.radius[b], share, worst);
        }
    }
    return worst;
}

SimScene some_scene(Random& random) {
    if (random.coin()) return heap(random, random.between(2, 4), 0.05);
    SimScene scene = plain_weave({.count = 2, .points_a_crossing = random.between(2, 4), .swing = 0.7});
    for (SimYarn& yarn : scene.yarns) shake(random, yarn, 0.03);
    return scene;
}

}  // namespace

TEST_CASE("a safe share of a change brings no pair nearer by half, and is not smaller than it must be") {
    weave::testing::for_all(
        [](Random& random) {
            Bench bench(some_scene(random));
            bench.evaluate();
            const std::vector<double> change =
                random_change(random, bench, std::pow(10, uniform(random, -3, 1)));
            const double share = bench.energy.safe_share(bench.state, change, 2);
            REQUIRE(share >= 0);
            REQUIRE(share <= 2);
            const Worst worst = worst_of(bench, change, share);
            CHECK((share == 0) == worst.crushed);
            CHECK(worst.lines <= 0.45 * (1 + 1e-9));
            const double reach = bench.fabric.least_reach();
            CHECK(worst.pair <= 0.45 * (1 + 1e-9));
            CHECK(worst.movement <= reach / 4 * (1 + 1e-9));
            const bool binds = share == 2 || worst.crushed || worst.lines > 0.45 * (1 - 1e-9) ||
                               worst.pair > 0.45 * (1 - 1e-9) || worst.movement > reach / 4 * (1 - 1e-9);
            CHECK(binds);
        },
        200);
}

TEST_CASE("whole cloth moved at once is bounded by the samples' reach alone") {
    Bench bench(plain_weave({}));
    bench.evaluate();
    std::vector<double> change(bench.state.size(), 0.0);
    for (std::size_t i = 2; i < change.size(); i += 3) change[i] = 1;
    CHECK(bench.energy.safe_share(bench.state, change, 10) == Approx(bench.fabric.least_reach() / 4));
    const std::vector<double> nothing(bench.state.size(), 0.0);
    CHECK(bench.energy.safe_share(bench.state, nothing, 10) == 10);
}

TEST_CASE("a shortened change is safe") {
    weave::testing::for_all(
        [&](Random& random) {
            Bench bench(some_scene(random));
            bench.evaluate();
            std::vector<double> change = random_change(random, bench, std::pow(10, uniform(random, -3, 1)));
            const std::vector<double> before = change;
            bench.energy.shorten(bench.state, change);
            for (std::size_t slot = 0; slot < bench.fabric.slots(); ++slot) {
                if (bench.fabric.moves()[slot] == 0) continue;
                const Vec3 now = load(&change[3 * slot]), was = load(&before[3 * slot]);
                CHECK(now.norm() <= was.norm());
                CHECK(now.cross(was).norm() <= 1e-12 * was.squaredNorm());
            }
            CHECK(worst_of(bench, change, 1).pair < 1);
            CHECK(bench.energy.safe_share(bench.state, change, 1) >= 0.9);
        },
        200);
}

TEST_CASE("one place where nothing may move does not hold up the rest") {
    // Two crossing yarns that lie all but on one another and are pressed together, and a third that is free.
    SimScene scene;
    for (const int k : {0, 1, 2}) {
        SimYarn yarn = usual_yarn();
        yarn.is_fed = false;
        const Vec3 along = k == 1 ? Vec3(0, 1, 0) : Vec3(1, 0, 0), middle = k == 2 ? Vec3(0, 5, 0) : Vec3(0, 0, k * 0.002);
        scene.yarns.push_back(laid(yarn, middle - along, middle + along, 9));
    }
    Bench bench(scene);
    bench.evaluate();
    std::vector<double> change(bench.state.size(), 0.0);
    for (std::size_t i = 0; i < 9; ++i) {
        change[bench.at(0, i) + 2] = 0.01;
        change[bench.at(1, i) + 2] = -0.01;
        change[bench.at(2, i) + 2] = 0.01;
    }
    CHECK(bench.energy.safe_share(bench.state, change, 1) == 0);
    bench.energy.shorten(bench.state, change);
    CHECK(bench.energy.safe_share(bench.state, change, 1) >= 0.9);
    CHECK(change[bench.at(2, 4) + 2] == 0.01);
    CHECK(change[bench.at(0, 4) + 2] == Approx(0).margin(1e-7));
    CHECK(change[bench.at(1, 4) + 2] == Approx(0).margin(1e-7));
    CHECK(change[bench.at(0, 4) + 2] <= change[bench.at(1, 4) + 2]);  // the first lies below
}

TEST_CASE("yarns that are pressed together are held across one another alone") {
    weave::testing::for_all(
        [](Random& random) {
            SimScene scene;
            const double turn = uniform(random, 0.2, 1.5);
            for (const int k : {0, 1}) {
                SimYarn yarn = usual_yarn();
                yarn.is_fed = false;
                const Vec3 along = k == 1 ? Vec3(std::cos(turn), std::sin(turn), 0) : Vec3(1, 0, 0), middle(0, 0, k * 0.002);
                scene.yarns.push_back(laid(yarn, middle - along, middle + along, 9));
            }
            Bench bench(scene);
            bench.evaluate();
            // Each slides along the other's plane, and both are carried upwards while they are pressed together.
            const double pressed = uniform(random, 1e-6, 0.002), carried = uniform(random, -0.002, 0.002);
            const Vec3 slides[]{{uniform(random, -5e-4, 5e-4), uniform(random, -5e-4, 5e-4), 0}, {uniform(random, -5e-4, 5e-4), uniform(random, -5e-4, 5e-4), 0}};
            std::vector<double> change(bench.state.size(), 0.0);
            for (const std::size_t y : {0, 1}) {
                for (std::size_t i = 0; i < 9; ++i) {
                    for (std::size_t k = 0; k < 2; ++k) change[bench.at(y, i) + k] = slides[y][static_cast<Eigen::Index>(k)];
                    change[bench.at(y, i) + 2] = carried + (y == 0 ? pressed : -pressed);
                }
            }
            CHECK(bench.energy.safe_share(bench.state, change, 1) == 0);
            bench.energy.shorten(bench.state, change);
            CHECK(bench.energy.safe_share(bench.state, change, 1) >= 0.9);
            for (const std::size_t y : {0, 1}) {
                const Vec3 left = load(&change[bench.at(y, 4)]);
                CHECK(left.z() == Approx(carried).margin(1e-6 * pressed + 1e-8));
                CHECK((left - slides[y]).head<2>().norm() <= 1e-12);
            }
            CHECK(change[bench.at(0, 4) + 2] <= change[bench.at(1, 4) + 2]);
        },
        100);
}

TEST_CASE("samples that lie behind one another on a yarn that is pushed together hold nothing") {
    SimScene scene;
    SimYarn yarn = usual_yarn();
    yarn.is_fed = false;
    scene.yarns.push_back(laid(yarn, Vec3(-2, 0, 0), Vec3(2, 0, 0), 41));
    Bench bench(scene);
    bench.evaluate();  // with the lengths by which a yarn knows its own stretch
    weave::testing::Random random(5);
    for (std::size_t i = 0; i < 41; ++i) {
        bench.state[bench.at(0, i)] *= 0.15;
        bench.state[bench.at(0, i) + 1] = uniform(random, -5e-4, 5e-4);
    }
    bench.fabric.follow(bench.state);
    bench.evaluate();
    std::vector<double> change = random_change(random, bench, 1e-5);
    CHECK(bench.energy.safe_share(bench.state, change, 1) == 1);
}

TEST_CASE("a change that is safe is not shortened") {
    weave::testing::for_all(
        [](Random& random) {
            Bench bench(some_scene(random));
            bench.evaluate();
            std::vector<double> change = random_change(random, bench, 1e-6);
            if (bench.energy.safe_share(bench.state, change, 1) < 1) return;
            const std::vector<double> before = change;
            bench.energy.shorten(bench.state, change);
            CHECK(change == before);
        },
        50);
}
