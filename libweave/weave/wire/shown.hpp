#pragma once

#include <weave/sim/run.hpp>
#include <weave/wire/frame.hpp>
#include <weave/wire/message.hpp>

namespace weave::wire {

/// What the yarns of a run's frames are, with the radii that they are led to; its numbers of session, event and layout stay 1.
Layout layout_of(const sim::Run& run);

/// The control points of a run as they lie; the head has its size and quantum, all else is left to the caller.
Frame frame_of(const sim::Run& run);

}  // namespace weave::wire
