#pragma once

#include <weave/design/design.hpp>
#include <weave/loom/check.hpp>
#include <weave/sim/yarns.hpp>

#include <cstddef>

namespace weave {

/// Take-up of a yarn that lies in the cloth once: (its length - the cloth's) / the cloth's, where the cloth's
/// is one repeat, or the straight way from one end of the yarn to the other. 0 where that has no length.
double take_up_of(const SimulatedYarn& yarn);

/// What check_for_loom() wants to know of a design, whose cloth is `block`. Take-up and lengths are NaN of
/// ends that were not simulated. A weft yarn belongs to the feeder that all its picks have in common; of
/// several the first whose yarn looks like it. Errors: yarns of another design, of a part of the cloth, not
/// at rest, or with crossings that changed: nothing that a loom should be set up by; ends or picks that the
/// design does not have.
Result<RelaxedCloth> relaxed_cloth(const Yarns& yarns, const Design& design, const Block& block);

}  // namespace weave
