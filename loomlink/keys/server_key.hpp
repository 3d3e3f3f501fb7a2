#pragma once

#include <weave/core/result.hpp>

#include <filesystem>
#include <loomlink/keys/key.hpp>

namespace weave::loomlink {

/// The keys that the server itself holds, in files of its data folder: one for the heads of the log, one for
/// the freshness of release indexes. Neither can release anything.
enum class ServerKeyRole : std::uint8_t { log, stamp };

/// Makes a key and its file (mode 0600). Refused where the file exists already.
Result<KeyPair> create_server_key(const std::filesystem::path& path, ServerKeyRole role);

/// Reads a key. Refused: a file that others may read, a key of the other role; an error for a file that was
/// altered.
Result<KeyPair> load_server_key(const std::filesystem::path& path, ServerKeyRole role);

}  // namespace weave::loomlink
