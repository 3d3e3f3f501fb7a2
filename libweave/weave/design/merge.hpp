#pragma once

#include <weave/design/design.hpp>

#include <string>

namespace weave {

/// A block name that the design does not use yet: `wish` itself, or `wish-2`, `wish-3` and so on. A wish
/// longer than a block name may be is cut.
std::string free_name(const Design& design, const std::string& wish);

/// Brings all that `from`'s cloth is made from into `into` and gives the name that its root has there. A
/// block that stands there already, equal down to its leaves, is shared; one of the same name that differs is
/// brought in under a free name. Only blocks are brought in: yarns, feeders and scene of `into` stay as they
/// are.
std::string bring_in(Design& into, const Design& from);

/// Whether both designs set up the same warp and weft, so that bringing one into the other loses nothing.
bool same_yarns(const Design& a, const Design& b);

}  // namespace weave
