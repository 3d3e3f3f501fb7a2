#pragma once

#include <weave/sim/run.hpp>
#include <weave/wire/frame.hpp>
#include <weave/wire/message.hpp>

#include <string>

namespace weave::simd {

/// What the yarns of a run's frames are now; its numbers of session, event and layout stay 1.
wire::Layout layout_of(const sim::Run& run);

/// Hash of what a layout says of its yarns, whatever its numbers.
std::string layout_sha256(wire::Layout layout);

/// The control points of a run as they lie; the head has its size and quantum, all else is left to the caller.
wire::Frame frame_of(const sim::Run& run);

}  // namespace weave::simd
