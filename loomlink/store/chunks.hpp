#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace weave::loomlink {

/// Bounds of a chunk in bytes. They may change: what is stored keeps its chunks, it only shares fewer with
/// what comes.
inline constexpr std::size_t least_chunk = 4096;
inline constexpr std::size_t usual_chunk = 16384;
inline constexpr std::size_t most_chunk = 65536;

/// Cuts bytes where their content says, so that an edit moves the cuts beside it alone and all other chunks
/// stay the same: the gear hash of FastCDC (Xia et al., USENIX ATC 2016), with a stricter mask before the
/// usual size than behind it.
std::vector<std::string_view> cut_into_chunks(std::string_view bytes);

}  // namespace weave::loomlink
