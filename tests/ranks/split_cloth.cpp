// A cloth in blocks has the energy, the forces and the second derivatives of the whole, and every number of it is the same
// whoever has which blocks.

#include "split_cases.hpp"
#include "thread_ranks.hpp"

#include <weave/sim/host_cloth.hpp>
#include <weave/sim/relax.hpp>
#include <weave/sim/relaxing.hpp>

#include <cmath>
#include <random>

namespace weave::ranks::testing {

namespace {

const std::vector<Case>& cases() {
    static const std::vector<Case> all{
        {"plain", 8, true},          // periodic, and so small that its own images touch it
        {"satin-5", 25},
        {"twill-g", 100, true},
        {"hexagon-tubes", 200},
        {"angle-interlock-b", 150},
        {"orthogonal", 64, true, WeftMode::wraparound},
        {"satin-e", 120, true, WeftMode::wraparound},
        {"twill-g", 90, true, {}, Region{0, 4, 1, 6}},
        {"pocket", 700},              // free rims
    };
    return all;
}

/// Moves every point of the whole a little, the same for the parts.
std::vector<double> shaken(std::vector<double> state, const sim::Fabric<double>& fabric) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> some(-0.1, 0.1);
    for (std::size_t slot = 0; slot < fabric.slots(); ++slot) {
        for (std::size_t k = 3 * slot; fabric.moves()[slot] != 0 && k < 3 * slot + 3; ++k) state[k] += some(random) * fabric.least_reach();
    }
    fabric.follow(state);
    return state;
}

std::vector<double> taken(const std::vector<double>& whole, const std::vector<std::size_t>& slots) {
    std::vector<double> numbers;
    for (const std::size_t slot : slots) numbers.insert(numbers.end(), whole.begin() + std::ptrdiff_t(slot), whole.begin() + std::ptrdiff_t(slot) + 3);
    return numbers;
}

}  // namespace

TEST_CASE("energy, forces and what they are measured by are those of the whole, wherever it is cut") {
    for (const Case& of : cases()) {
        INFO(of.sample);
        const sim::Plan plan = plan_of(of);
        const sim::Executor executor(1);
        const sim::Fabric<double> fabric(plan.scene);
        sim::Energy<double> energy(fabric, executor);
        energy.first_weights(fabric.state());
        const std::vector<double> state = shaken(fabric.state(), fabric);
        std::vector<double> gradient;
        const double value = energy.evaluate(state, gradient);

        SerialComm comm;
        const CutPlan cut = cut_of(of, comm);
        REQUIRE(cut.cut.count() > 1);
        std::vector<double> own = planned(cut.parts);
        SplitCloth cloth(comm, cut.cut, cut.parts, executor, own);
        const std::vector<std::size_t> slots = slots_of(cut.parts, fabric);
        cloth.state = taken(state, slots);
        CHECK(cloth.evaluate() == Approx(value).epsilon(1e-13));
        const std::vector<double> wanted = taken(gradient, slots);
        const double greatest = sim::greatest_force(executor, gradient);
        double worst = 0;
        for (std::size_t i = 0; i < wanted.size(); ++i) worst = std::max(worst, std::abs(wanted[i] - cloth.gradient[i]));
        CHECK(worst < 1e-12 * greatest);
        CHECK(greatest > 0.1);
        CHECK(cloth.greatest_strain() == Approx(sim::greatest_strain(fabric, state)).epsilon(1e-12));
        CHECK(cloth.reference_force() == Approx(sim::reference_force(energy, state)).epsilon(1e-12));
    }
}

TEST_CASE("second derivatives and safe steps are those of the whole") {
    for (const Case& of : cases()) {
        INFO(of.sample);
        const sim::Plan plan = plan_of(of);
        const sim::Executor executor(1);
        const sim::Fabric<double> fabric(plan.scene);
        sim::Energy<double> energy(fabric, executor);
        std::vector<double> state = fabric.state();
        sim::HostCloth<double> whole(energy, state);
        SerialComm comm;
        const CutPlan cut = cut_of(of, comm);
        std::vector<double> own = planned(cut.parts);
        SplitCloth parts(comm, cut.cut, cut.parts, executor, own);
        whole.evaluate();
        parts.evaluate();
        for (const sim::Curvature curvature : {sim::Curvature::convex, sim::Curvature::exact}) {
            whole.assemble(curvature);
            parts.assemble(curvature);
            whole.change = whole.gradient;
            whole.aim_along_change();
            parts.change = parts.gradient;
            parts.aim_along_change();
            CHECK(parts.curvature() == Approx(whole.curvature()).epsilon(1e-5));
        }
        whole.scale(whole.change, 1 / whole.greatest_force(whole.change));
        fabric.follow_change(whole.change);
        parts.change = taken(whole.change, slots_of(cut.parts, fabric));
        CHECK(parts.safe_share(parts.change, 8) == Approx(whole.safe_share(whole.change, 8)).epsilon(1e-12));
        parts.shorten(parts.change);
        whole.shorten(whole.change);
        const std::vector<double> wanted = taken(whole.change, slots_of(cut.parts, fabric));
        for (std::size_t i = 0; i < wanted.size(); ++i) REQUIRE(parts.change[i] == Approx(wanted[i]).margin(1e-12));
    }
}

TEST_CASE("the preconditioner of blocks is symmetric and leads downhill") {
    const sim::Executor executor(1);
    SerialComm comm;
    const CutPlan cut = cut_of({"hexagon-tubes", 200}, comm);
    std::vector<double> own = planned(cut.parts);
    SplitCloth cloth(comm, cut.cut, cut.parts, executor, own);
    cloth.evaluate();
    cloth.assemble(sim::Curvature::convex);
    cloth.add_to_pivots(1e-5F);
    cloth.factor();
    cloth.start_from_gradient();
    const std::vector<double> one = cloth.residual;
    const double down = cloth.precondition();
    CHECK(down > 0);
    const std::vector<double> of_one = cloth.solved;
    cloth.start_at_random();
    CHECK(cloth.precondition() > 0);
    CHECK(cloth.dot(one, cloth.solved) == Approx(cloth.dot(of_one, cloth.residual)).epsilon(1e-9));
}

namespace {

/// The state after so many steps, of all ranks in their order, with what was decided by.
std::vector<double> after_steps(const Case& of, std::size_t ranks, int steps) {
    std::vector<std::vector<double>> of_rank(ranks);
    by_ranks(ranks, [&](Comm& comm) {
        const sim::Executor executor(1);
        const CutPlan cut = cut_of(of, comm);
        std::vector<double> own = planned(cut.parts);
        SplitCloth cloth(comm, cut.cut, cut.parts, executor, own);
        sim::Relaxing<SplitCloth> relaxing;
        relaxing.begin(cloth, cloth.greatest_strain());
        for (int k = 0; k < steps; ++k) {
            relaxing.judge(cloth);
            if (relaxing.step(cloth) != sim::Step::done) break;
        }
        relaxing.finish(cloth);
        if (comm.is_first()) own.insert(own.begin(), {relaxing.energy, relaxing.residual, static_cast<double>(relaxing.iterations)});
        of_rank[comm.rank()] = own;
    });
    std::vector<double> all;
    for (const std::vector<double>& own : of_rank) all.insert(all.end(), own.begin(), own.end());
    return all;
}

}  // namespace

TEST_CASE("any number of ranks comes to the same bits") {
    for (const Case& of : {Case{"angle-interlock-b", 60}, Case{"twill-g", 40, true}, Case{"hexagon-tubes", 120}}) {
        INFO(of.sample);
        const std::vector<double> alone = after_steps(of, 1, 25);
        REQUIRE(alone[2] > 20);
        for (const std::size_t ranks : {2, 3, 8}) CHECK(after_steps(of, ranks, 25) == alone);
    }
}

TEST_CASE("near a rest of the whole the blocks come to that rest") {
    // Hexagon tubes leave for a rest 0.04 radii away, as they do on a device (docs/simulation.md): they are not among these.
    for (Case of : {Case{"satin-5", 50}, Case{"angle-interlock-b", 200}, Case{"orthogonal", 100}, Case{"twill-g", 100, true},
                           Case{"twill-g", 90, true, {}, Region{0, 4, 1, 6}}, Case{"satin-e", 60, true, {}, Region{0, 7, 0, 4}}}) {
        of.fidelity = sim::Fidelity::standard;
        of.points_a_block *= 2;
        INFO(of.sample << (of.region ? ", a region" : ""));
        const sim::Plan plan = plan_of(of);
        const sim::Executor executor(2);
        const sim::Fabric<double> fabric(plan.scene);
        sim::Energy<double> energy(fabric, executor);
        energy.first_weights(fabric.state());
        std::vector<double> state = fabric.state();
        sim::RelaxOptions options;
        options.residual = 1e-8;
        REQUIRE(sim::relax(energy, state, options).ending == sim::Ending::converged);

        SerialComm comm;
        const CutPlan cut = cut_of(of, comm);
        std::vector<double> own = planned(cut.parts);
        SplitCloth cloth(comm, cut.cut, cut.parts, executor, own);
        const std::vector<double> rest = taken(state, slots_of(cut.parts, fabric));
        std::mt19937 random(3);
        std::uniform_real_distribution<double> some(-0.01, 0.01);
        const double radius = fabric.least_reach() / 2;
        cloth.state = rest;
        std::size_t at = 0;
        for (const Part& part : cut.parts) {
            for (const Point& point : part.own) {
                for (int k = 0; k < 3; ++k, ++at) cloth.state[at] += cut.cut.moves(point) ? some(random) * radius : 0;
            }
        }
        cloth.begin_anew();
        sim::Relaxing<SplitCloth> relaxing;
        relaxing.goal = 1e-8;
        relaxing.begin(cloth, cloth.greatest_strain());
        for (relaxing.judge(cloth); !relaxing.is_at_goal() && relaxing.iterations < 2000; relaxing.judge(cloth)) {
            if (relaxing.step(cloth) != sim::Step::done) break;
        }
        CHECK(relaxing.residual <= 1e-8);
        // A periodic cloth may have drifted as a whole, each way by itself.
        Vec3 drift(0, 0, 0);
        for (std::size_t i = 0; !of.region && i < rest.size(); ++i) drift[Eigen::Index(i % 3)] += (cloth.state[i] - rest[i]) / (static_cast<double>(rest.size()) / 3);
        double worst = 0;
        for (std::size_t i = 0; i < rest.size(); ++i) worst = std::max(worst, std::abs(cloth.state[i] - rest[i] - drift[Eigen::Index(i % 3)]));
        CHECK(worst < 1e-4 * radius);
    }
}

}  // namespace weave::ranks::testing
