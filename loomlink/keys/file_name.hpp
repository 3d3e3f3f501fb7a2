#pragma once

#include <weave/core/result.hpp>

#include <string>
#include <string_view>

namespace weave::loomlink {

/// Whether a name may name a file of a release, on every system of a mill: 1 to 100 ASCII letters, digits,
/// points, hyphens and underscores; no folder, nothing that starts with a point or a hyphen or ends with a
/// point, no name that Windows keeps for a device. The error says which rule it breaks.
Status check_file_name(std::string_view name);

/// Whether Windows keeps this name, in any capitals, for a device: CON, PRN, AUX, NUL, COM0 to COM9, LPT0 to
/// LPT9. It does so with any ending, so `name` is what stands before the first point.
bool is_device_name(std::string_view name);

/// A name as systems compare it that see no difference between small and capital letters.
std::string folded_name(std::string_view name);

}  // namespace weave::loomlink
