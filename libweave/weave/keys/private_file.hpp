#pragma once

#include <weave/core/result.hpp>
#include <weave/keys/secret_bytes.hpp>

#include <filesystem>
#include <string_view>

namespace weave {

/// Makes a file that its owner alone may read and write (mode 0600), whole or not at all, whenever the power
/// fails. A file that is there already is never replaced: refused.
Status create_private_file(const std::filesystem::path& path, std::string_view bytes);

/// The same, in place of the private file that is there, if any. Refused where that is not private, see
/// check_private_file().
Status write_private_file(const std::filesystem::path& path, std::string_view bytes);

/// Refused: a file that others than its owner may read or write, that belongs to somebody else than the user
/// of this process, or that is no regular file (a symbolic link neither).
Status check_private_file(const std::filesystem::path& path);

/// Tells the log where others than its owner may read or write a regular file with a secret in it. For secrets that people
/// keep with a redirection, as shells write it.
void warn_if_not_private(const std::filesystem::path& path);

/// The content of a private file, straight into guarded memory. Errors: missing, more than `limit` bytes, and
/// what check_private_file() refuses.
Result<SecretBytes> read_private_file(const std::filesystem::path& path, std::size_t limit);

}  // namespace weave
