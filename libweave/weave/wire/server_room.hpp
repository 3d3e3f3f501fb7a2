#pragma once

#include <weave/sim/memory_room.hpp>
#include <weave/wire/place.hpp>

namespace weave::wire {

/// What a server has for all that it computes, as it says itself. Errors: it cannot be asked, or does not say.
Result<sim::MemoryRoom> room_on(const ServerPlace& place);

}  // namespace weave::wire
