#pragma once

#include <weave/sim/plan.hpp>

#include <string>
#include <studio/jobs/happenings.hpp>

namespace weave::studio {

/// What a plan models and why, and what it is expected to take.
PlanSummary summary_of(const sim::Plan& plan, const std::string& title);

}  // namespace weave::studio
