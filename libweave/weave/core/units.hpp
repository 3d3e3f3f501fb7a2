#pragma once

namespace weave {

/// The one system of units: millimetre, gram, millisecond. Forces come out in newton (g·mm/ms²), stress in
/// N/mm². Inside kernels plain doubles carry a suffix (`radius_mm`, `stiffness_N`); at the edges these
/// conversions are used.
namespace units {

/// Gravity in mm/ms².
inline constexpr double standard_gravity = 9.80665e-3;

/// Mass of a yarn per millimetre, g/mm, from its linear density in tex (g/km).
constexpr double gram_per_mm(double tex) {
    return tex * 1e-6;
}

/// Spacing in mm of yarns that lie `per_cm` to the centimetre.
constexpr double spacing_mm(double per_cm) {
    return 10.0 / per_cm;
}

}  // namespace units

}  // namespace weave
