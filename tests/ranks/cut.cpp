// Which block a point belongs to follows from the plan alone, and every point belongs to one.

#include "split_cases.hpp"
#include "thread_ranks.hpp"

#include <map>
#include <mutex>

namespace weave::ranks::testing {

TEST_CASE("every point belongs to one block, the same whatever the number of ranks") {
    const sim::Plan plan = plan_of({"angle-interlock-b", 0});
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> alone;
    for (const std::size_t ranks : {1, 2, 5, 8, 40}) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> found;
        std::mutex mutex;
        by_ranks(ranks, [&](Comm& comm) {
            const CutPlan cut = cut_of({"angle-interlock-b", 60}, comm);
            const auto [first, last] = cut.cut.blocks_of(comm.rank(), comm.size());
            const std::lock_guard lock(mutex);
            REQUIRE(cut.parts.size() == last - first);
            for (std::size_t b = 0; b < cut.parts.size(); ++b) {
                REQUIRE(cut.cut.rank_of(first + b, comm.size()) == comm.rank());
                for (const Point& point : cut.parts[b].own) {
                    REQUIRE(point.block == first + b);
                    REQUIRE(found.emplace(std::pair(point.yarn, point.index), point.block).second);
                }
            }
        });
        std::size_t points = 0;
        for (const sim::SimYarn& yarn : plan.scene.yarns) points += yarn.control.size();
        CHECK(found.size() == points);
        if (ranks == 1) alone = found;
        CHECK(found == alone);
    }
}

TEST_CASE("blocks have about as many points each") {
    for (const char* sample : {"angle-interlock-b", "pocket", "hexagon-tubes"}) {
        INFO(sample);
        SerialComm comm;
        const CutPlan cut = cut_of({sample, 100}, comm);
        std::size_t least = SIZE_MAX, most = 0;
        for (const Part& part : cut.parts) {
            least = std::min(least, part.own.size());
            most = std::max(most, part.own.size());
        }
        CHECK(least > 0);
        CHECK(most <= 2 * 100);
    }
}

TEST_CASE("what is not computed by several processes is refused, by name") {
    Design design = find_sample("satin-5")->make();
    const auto refused = [&](const sim::SimulationRequest& request) {
        const BlockPtr block = evaluate(design)->block;
        const auto plan = sim::PlanInStretches::make(design, *block, request);
        REQUIRE(plan);
        return cut_plan(*plan, 0, 1).error().text();
    };
    sim::SimulationRequest relaxing;
    relaxing.relaxing_N_per_mm[0] = 1;
    CHECK_THAT(refused(relaxing), Catch::Contains("period") && Catch::Contains("without mpirun"));
    design.scene.friction = 0.2;
    CHECK_THAT(refused({}), Catch::Contains("friction") && Catch::Contains("without mpirun"));
}

}  // namespace weave::ranks::testing
