#pragma once

#include <weave/sim/plan.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <studio/jobs/happenings.hpp>

namespace weave::studio {

/// What a plan models and why, and what it is expected to take.
PlanSummary summary_of(const sim::Plan& plan, const std::string& title);

/// Memory of this computer that is free; nothing where the system does not say.
std::optional<std::uint64_t> free_memory();

}  // namespace weave::studio
