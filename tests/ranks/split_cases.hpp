#pragma once

#include <weave/design/evaluate.hpp>
#include <weave/ranks/split_cloth.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/energy.hpp>
#include <weave/sim/plan.hpp>

#include <catch2/catch.hpp>

#include <string>
#include <vector>

namespace weave::ranks::testing {

/// A cloth that is cut into blocks of so many points.
struct Case {
    std::string sample;
    std::size_t points_a_block;
    bool is_whole = false;
    std::optional<WeftMode> weft_mode = {};
    std::optional<Region> region = {};
    sim::Fidelity fidelity = sim::Fidelity::draft;
};

inline sim::SimulationRequest request_of(const Case& of) {
    sim::SimulationRequest request;
    request.fidelity = of.fidelity;
    request.reduce = !of.is_whole;
    request.weft_mode = of.weft_mode;
    request.region = of.region;
    return request;
}

inline sim::Plan plan_of(const Case& of) {
    const Design design = find_sample(of.sample)->make();
    auto plan = sim::make_plan(design, *evaluate(design)->block, request_of(of));
    REQUIRE(plan);
    return *std::move(plan);
}

/// A plan in stretches with what it looks at.
struct Stretched {
    Design design;
    BlockPtr block;
    sim::PlanInStretches plan;

    explicit Stretched(const Case& of) : design(find_sample(of.sample)->make()), block(evaluate(design)->block) {
        auto made = sim::PlanInStretches::make(design, *block, request_of(of), 64);
        if (!made) throw std::runtime_error(made.error().text());
        plan = *std::move(made);
    }
    Stretched(const Stretched&) = delete;
    Stretched& operator=(const Stretched&) = delete;
};

inline CutPlan cut_of(const Case& of, const Comm& comm) {
    const Stretched stretched(of);
    auto cut = cut_plan(stretched.plan, comm.rank(), comm.size(), of.points_a_block);
    if (!cut) throw std::runtime_error(cut.error().text());
    return *std::move(cut);
}

inline std::vector<double> planned(const std::vector<Part>& parts) {
    std::vector<double> places;
    for (const Part& part : parts) {
        for (const Point& point : part.own) places.insert(places.end(), point.planned.data(), point.planned.data() + 3);
    }
    return places;
}

/// Where the numbers of a part's points lie in a vector of the slots of the whole.
inline std::vector<std::size_t> slots_of(const std::vector<Part>& parts, const sim::Fabric<double>& fabric) {
    std::vector<std::size_t> slots;
    for (const Part& part : parts) {
        for (const Point& point : part.own) slots.push_back(3 * (std::size_t(fabric.yarns()[point.yarn].first_slot) + 1 + point.index));
    }
    return slots;
}

}  // namespace weave::ranks::testing
