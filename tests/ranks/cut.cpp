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
            const CutPlan cut = cut_of(plan, comm, 60);
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
        const CutPlan cut = cut_of(plan_of({sample, 0}), comm, 100);
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
    sim::Plan plan = plan_of({"satin-5", 0});
    const auto refused = [&] { return cut_plan(plan, 0, 1).error().text(); };
    plan.scene.friction = 0.2;
    CHECK_THAT(refused(), Catch::Contains("friction") && Catch::Contains("without mpirun"));
    plan.scene.friction = 0;
    plan.rim_force_N[0] = 1;
    CHECK_THAT(refused(), Catch::Contains("period"));
    plan.rim_force_N[0].reset();
    plan.scene.transition.emplace();
    CHECK_THAT(refused(), Catch::Contains("flip"));
}

}  // namespace weave::ranks::testing
