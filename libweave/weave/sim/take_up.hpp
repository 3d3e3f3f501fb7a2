#pragma once

#include <weave/design/design.hpp>
#include <weave/loom/check.hpp>
#include <weave/sim/yarns.hpp>

#include <cstddef>

namespace weave {

/// Take-up of a yarn that lies in the cloth once: (its length - the cloth's) / the cloth's, where the cloth's
/// is one repeat, or the straight way from one end of the yarn to the other. 0 where that has no length.
double take_up_of(const SimulatedYarn& yarn);

/// The take-up of each end of a design of `ends` ends for check_for_loom(), NaN of those that were not
/// simulated. Errors: yarns of another design, of a part of the cloth, not at rest, or with crossings that
/// changed: nothing that a loom should be set up by.
Result<TakeUps> take_ups_of(const Yarns& yarns, const Design& design, std::size_t ends);

}  // namespace weave
