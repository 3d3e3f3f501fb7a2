#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace weave::loomlink {

/// The bytes of a stored chunk; nothing where they are not `size` bytes, as of a damaged one.
std::optional<std::string> unpack_chunk(const std::string& bytes, bool packed, std::int64_t size);

}  // namespace weave::loomlink
