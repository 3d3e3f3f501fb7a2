#pragma once

#include <weave/sim/plan.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <studio/jobs/happenings.hpp>

namespace weave::studio {

/// What a plan models and why, and what it is expected to take.
PlanSummary summary_of(const sim::Plan& plan, const std::string& title);

/// Control points that a plan of this cloth will have, at a rough guess that takes no time: a key point where a
/// pick passes a column of stacks, or an end a row. Nothing where its smallest repeat may do, which the plan finds.
std::optional<std::size_t> foreseen_points(const Design& design, const Block& block, const sim::SimulationRequest& request);

/// Why a run that needs so much is not begun where so much is free, with what would help: a part of the cloth, and a
/// rougher fidelity where there is one.
Error lack_of_memory(std::uint64_t needed, std::uint64_t free, sim::Fidelity fidelity);

/// Memory of this computer that is free; nothing where the system does not say.
std::optional<std::uint64_t> free_memory();

}  // namespace weave::studio
