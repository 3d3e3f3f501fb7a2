#pragma once

#include <weave/core/result.hpp>
#include <weave/curve/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weave::wire {

/// Version of the layout of frames; others are refused. Byte by byte: PROTOCOL.md.
inline constexpr std::uint16_t frame_version = 1;
/// Bytes before the first yarn of a frame.
inline constexpr std::size_t frame_head_bytes = 80;
/// No frame is longer.
inline constexpr std::size_t most_frame_bytes = std::size_t{64} << 20;
/// No place of a frame lies further from the origin along an axis, and no size is larger, mm.
inline constexpr double farthest_mm = 1e9;
/// Numbers of sessions, frames, steps and events lie below 2^53, so that JSON can tell them exactly.
inline constexpr std::uint64_t most_number = (std::uint64_t{1} << 53) - 1;

/// What a frame says of a session beside places.
struct FrameHead {
    std::uint64_t session = 1;  ///< from 1
    std::uint64_t number = 1;   ///< of the frame in its session, from 1; a jump tells of frames that were left out
    std::uint64_t step = 0;     ///< how many steps were made before
    double residual = 0;        ///< greatest force over the reference force (sim/relax.hpp), 0 or more
    std::optional<std::uint32_t> lost_crossings;  ///< out of order; nothing: not looked at. Below 2^32 - 1
    std::uint32_t layout = 1;       ///< number of the layout (message.hpp) that says what its yarns are, from 1
    std::array<double, 2> size_mm{};  ///< of the simulated piece along x and y; its period where it repeats
    double quantum_mm = 1;  ///< unit of its places, 1e-12 to 1e6
    bool at_rest = false;   ///< the residual is as small as was asked for
    bool is_last = false;   ///< nothing moves from here until somebody asks for it
    bool is_coarse = false;    ///< in the fewer points of a plan that comes before the one asked for
    bool is_flipping = false;  ///< two yarns are just being led past one another
};

/// The control points of all yarns of a session at one step.
struct Frame {
    FrameHead head;
    std::vector<std::uint32_t> counts;  ///< control points of each yarn, at least 1
    std::vector<Vec3> points;           ///< of all yarns, one after another, mm
};

/// The quantum with which no decoded point lies further than 1/50 of the smallest radius from where it was.
double quantum_for(double smallest_radius_mm);

/// The bytes of a frame. Places are rounded to its quantum; equal frames give equal bytes. Errors: what
/// decode_frame() would refuse, with its place, such as `yarns[3].points[5].x`.
Result<std::string> encode_frame(const Frame& frame);

/// The frame that these bytes are; encoding it gives them again. Every byte may be hostile: counts are checked
/// against the bytes that are there before anything is allocated, at most 24 bytes for each 3 that came.
/// Errors: what is wrong, and where.
Result<Frame> decode_frame(std::string_view bytes);

}  // namespace weave::wire
