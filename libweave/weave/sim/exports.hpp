#pragma once

#include <weave/sim/yarns.hpp>

#include <cstddef>
#include <string>

namespace weave {

/// Both exports turn the axes of the cloth, which are left-handed as seen on its face, into the right-handed
/// ones that other programs draw in: their x runs along the picks (from the first end), y along the ends
/// (from the first pick) and z up. So the cloth shows there as it is, with its twills turning the way they
/// turn in the loom. Lengths in mm.

/// An export has at most so many points.
inline constexpr std::size_t most_export_points = 8'000'000;

/// The centrelines as VTK PolyData (`.vtp`, XML with base64 data), one line a yarn, followed to a hundredth
/// of the yarn's radius. Point data: radius_mm, strain, contact_N, yarn (its number, from 1), system (0 weft,
/// 1 warp); ParaView's Tube filter with radius_mm makes yarns of them. Errors: no yarn, or too many points.
Result<std::string> write_vtp(const Yarns& yarns);

/// The yarns as closed round tubes in one Wavefront OBJ: 20 sides with smooth normals, vertex colours, a
/// group a yarn
/// (`end_12`, `pick_3`, numbers from 1). A periodic yarn is one repeat long. Errors: no yarn, or too many
/// points.
Result<std::string> write_obj(const Yarns& yarns);

}  // namespace weave
