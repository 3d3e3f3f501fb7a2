#include <studio/jobs/plan_summary.hpp>

#include <weave/sim/forecast.hpp>

namespace weave::studio {

PlanSummary summary_of(const sim::Plan& plan, const std::string& title) {
    PlanSummary summary;
    summary.title = title;
    summary.points = sim::points_of(plan);
    summary.yarns = plan.scene.yarns.size();
    summary.repeats = plan.repeats[0] * plan.repeats[1];
    summary.expected_bytes = sim::expected_bytes(plan);
    summary.lines = plan.lines;
    return summary;
}

}  // namespace weave::studio
