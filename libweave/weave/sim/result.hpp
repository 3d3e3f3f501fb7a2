#pragma once

// What is measured on relaxed yarns, and how a smallest repeat becomes the whole cloth again.

#include <weave/core/json.hpp>
#include <weave/design/design.hpp>
#include <weave/sim/energy.hpp>
#include <weave/sim/plan.hpp>
#include <weave/sim/yarns.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace weave::sim {

/// The yarns of what a plan simulates, in a state of its control points, without a report. `energy` is of the plan's scene.
Yarns yarns_in_state(const Design& design, const Plan& plan, Energy<double>& energy, const std::vector<double>& state);

/// The yarns of the whole cloth, by copies of those of its smallest repeat.
Yarns copied_back(Yarns yarns, const Plan& plan, const Design& design);

/// What of the cloth the yarns cover, first and last from 1, once a repeat has been copied back over it.
Json coverage_of(const Plan& plan);

/// The first and last pick and end that are crossed, from 1.
struct CrossedYarns {
    std::array<std::size_t, 2> picks{SIZE_MAX, 0}, ends{SIZE_MAX, 0};
    void add(const Crossing& crossing);
};
/// The same of a plan without its crossings.
Json coverage_of(const Plan& plan, CrossedYarns crossed);

/// Whether a point that is held helps to draw the segment that begins at this control point: its strain then follows from the
/// plan, and says nothing of the rest.
bool is_held_at(const SimYarn& yarn, std::size_t begin);

struct Contacts {
    std::size_t seen = 0;  ///< segments that touch one, by each segment: every pair twice
    double overlap = 0;        ///< greatest 1 - d/D, but of two yarns that are both held there
};
Contacts contacts_of(Energy<double>& energy, const std::vector<double>& state);

/// What the report of a run says of the coarser yarns that it began in, `report` being theirs; `taken`: not yet.
Json told_of_coarser(const Json& report);

/// The process's greatest memory so far in bytes; 0 where the system does not say.
std::uint64_t peak_bytes();

}  // namespace weave::sim
