#pragma once

#include <weave/core/result.hpp>
#include <weave/keys/key.hpp>

#include <filesystem>

namespace weave {

/// The keys that machines hold in files: the server's own, one for the heads of the log, one for the
/// freshness of release indexes and one for access tokens, in its data folder; and that of a machine whose
/// simulations count. None can release anything.
enum class ServerKeyRole : std::uint8_t { log, stamp, evidence, access };

/// Makes a key and its file (mode 0600). Refused where the file exists already.
Result<KeyPair> create_server_key(const std::filesystem::path& path, ServerKeyRole role);

/// Reads a key. Refused: a file that others may read, a key of the other role; an error for a file that was
/// altered.
Result<KeyPair> load_server_key(const std::filesystem::path& path, ServerKeyRole role);

}  // namespace weave
