#include "scenes.hpp"

#include <weave/sim/host_cloth.hpp>
#include <weave/sim/relax.hpp>
#include <weave/sim/relaxing.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

/// A cloth that lacks room at the `often`-th evaluation or matrix, as a device with short lists does, until room is made, by
/// one more each time; what it answers then is void.
class Cramped : public HostCloth<double> {
  public:
    Cramped(Bench<double>& bench, std::size_t often) : HostCloth(bench.energy, bench.state), m_often(often) {}

    [[nodiscard]] bool lacks_room() const { return m_lacks; }
    double evaluate() { return held(HostCloth::evaluate(), gradient); }
    double evaluate_trial() { return held(HostCloth::evaluate_trial(), trial); }
    double go(double share) { return held(HostCloth::go(share), trial); }
    double reference_force() { return held(HostCloth::reference_force(), trial); }
    void assemble(Curvature curvature) {
        HostCloth::assemble(curvature);
        held(0, trial);
    }
    void make_room() {
        m_lacks = false;
        m_asked = 0;
        ++m_often;
        ++m_rooms;
    }
    [[nodiscard]] std::size_t rooms() const { return m_rooms; }

  private:
    double held(double answer, Slots& slots) {
        m_lacks = ++m_asked >= m_often;
        if (!m_lacks) return answer;
        slots.assign(slots.size(), std::numeric_limits<double>::quiet_NaN());
        return std::numeric_limits<double>::quiet_NaN();
    }

    std::size_t m_often, m_asked = 0, m_rooms = 0;
    bool m_lacks = false;
};

/// Does what needs room, and makes it as often as it lacks; what lacks room leaves the state what it was.
template <class Work>
Step with_room(Cramped& cloth, Relaxing<Cramped>& relaxing, const Work& work) {
    const std::vector<double> before = cloth.state;
    while (true) {
        const Step how = work();
        if (how != Step::lacks_room) return how;
        REQUIRE(cloth.lacks_room());
        REQUIRE(cloth.state == before);
        cloth.make_room();
        REQUIRE(relaxing.evaluate(cloth) == Step::done);
    }
}

void lead(Cramped& cloth, Relaxing<Cramped>& relaxing, double strain) {
    with_room(cloth, relaxing, [&] { return relaxing.begin(cloth, strain); });
    while (true) {
        with_room(cloth, relaxing, [&] { return relaxing.judge(cloth); });
        if (relaxing.is_at_goal() && with_room(cloth, relaxing, [&] { return relaxing.leave_saddle(cloth); }) != Step::done) break;
        REQUIRE(relaxing.iterations < 1000);
        REQUIRE(with_room(cloth, relaxing, [&] { return relaxing.step(cloth); }) == Step::done);
    }
    with_room(cloth, relaxing, [&] { return relaxing.finish(cloth); });
}

/// Wefts that are laid half as long again as they are, which give way at first.
SimScene long_weave() {
    SimScene scene = plain_weave({.count = 2, .swing = 0.7});
    for (SimYarn& yarn : scene.yarns) {
        yarn.is_fed = false;
        yarn.rest_mm *= 0.6;
    }
    return scene;
}

constexpr std::size_t never = std::numeric_limits<std::size_t>::max();

}  // namespace

TEST_CASE("a cloth that lacks room again and again comes to the rest of one that does not") {
    struct Case {
        SimScene scene;
        double strain;
    };
    for (const Case& it : {Case{plain_weave({.count = 2}), 0}, Case{long_weave(), 1}, Case{pressed_rod(), 0}}) {
        Bench plain(it.scene);
        Cramped free(plain, never);
        Relaxing<Cramped> wanted;
        wanted.goal = 1e-8;
        lead(free, wanted, it.strain);
        for (const std::size_t often : {25, 11, 4, 1}) {
            INFO("room is short first at evaluation " << often);
            Bench bench(it.scene);
            Cramped cloth(bench, often);
            Relaxing<Cramped> relaxing;
            relaxing.goal = 1e-8;
            lead(cloth, relaxing, it.strain);
            CHECK(cloth.rooms() > 0);
            CHECK(relaxing.residual <= 1e-8);
            CHECK(relaxing.energy == Approx(wanted.energy).epsilon(1e-6));
            CHECK(relaxing.reference_N == Approx(wanted.reference_N).epsilon(1e-4));
            CHECK(relaxing.curves_down == wanted.curves_down);
        }
    }
}

TEST_CASE("steps that are led by hand are those of relax(), bit by bit") {
    for (const SimScene& scene : {plain_weave({.count = 2}), pressed_rod()}) {
        Bench by_hand(scene), bench(scene);
        Cramped cloth(by_hand, never);
        Relaxing<Cramped> relaxing;
        relaxing.goal = 1e-8;
        lead(cloth, relaxing, 0);
        const RelaxResult result = relax(bench.energy, bench.state, {.residual = 1e-8, .watch = {}});
        REQUIRE(result.ending == Ending::converged);
        CHECK(by_hand.state == bench.state);
        CHECK(relaxing.energy == result.energy);
        CHECK(relaxing.residual == result.residual);
        CHECK(relaxing.iterations == result.iterations);
        CHECK(by_hand.energy.evaluations() == result.evaluations);
    }
}

TEST_CASE("a step within a radius ends at it, and solves the matrix where that is out of reach") {
    Bench bench(plain_weave({.count = 2, .swing = 0.7}));
    HostCloth<double> cloth(bench.energy, bench.state);
    cloth.evaluate();
    cloth.assemble(Curvature::convex);
    cloth.add_to_pivots(1e-3F);
    cloth.factor();
    const RadiusStep whole = step_within(cloth, 1e150, 1e-10, 1000);
    CHECK_FALSE(whole.at_border);
    // The model falls by half of what the step's slope says, and residual = −gradient − A·step is 0.
    cloth.change_from(cloth.step);
    CHECK(whole.fall == Approx(-cloth.dot(cloth.gradient, cloth.change) / 2));
    const RadiusStep half = step_within(cloth, whole.size / 2, 1e-10, 1000);
    CHECK(half.at_border);
    CHECK_FALSE(half.curves_down);
    CHECK(half.size == Approx(whole.size / 2));
    CHECK(half.fall < whole.fall);
}
