#pragma once

#include <weave/sim/yarns.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace weave {

/// Version of the `.yarns` format that is written; a newer one is refused. The format: YARNS.md.
inline constexpr std::size_t yarns_file_version = 1;

/// What a `.yarns` file may hold at most.
inline constexpr std::size_t most_file_yarns = std::size_t{1} << 18;
inline constexpr std::size_t most_file_points = std::size_t{1} << 26;  ///< of all yarns together
inline constexpr std::size_t most_file_crossings = std::size_t{1} << 26;
inline constexpr std::size_t longest_yarns_header = std::size_t{1} << 26;  ///< bytes
/// No place lies further from the origin along an axis, and no length is larger, mm.
inline constexpr double farthest_place_mm = 1e9;

/// The bytes of a `.yarns` file, for write_file(). Equal content gives equal bytes.
/// Errors: content that read_yarns() would refuse, with its place, such as `yarns[3].radius_mm`.
Result<std::string> write_yarns(const Yarns& yarns);

/// Where the parts of a file lie, in bytes from its beginning, for what is written in pieces (FileInPieces).
struct YarnsLayout {
    std::string front;  ///< all before the arrays
    std::uint64_t control = 0, planned = 0, strain = 0, contact_N = 0, crossings = 0;
};

/// The layout of a file whose yarns have so many points each; what `bare` has of points and crossings does not count. The
/// arrays are the caller's to check.
Result<YarnsLayout> lay_out_yarns(const Yarns& bare, const std::vector<std::size_t>& points, std::size_t crossings);

/// Numbers, and crossings, as the arrays of a file hold them.
std::string file_bytes(std::span<const double> numbers);
std::string file_bytes(std::span<const Crossing> crossings);

/// The content of a `.yarns` file, exactly as it was given to write_yarns(). Every byte may be hostile: sizes
/// are checked before anything is allocated, numbers are finite, indices lie in range. Errors: what is wrong,
/// and where.
Result<Yarns> read_yarns(std::string_view bytes);

}  // namespace weave
