#pragma once

#include <weave/core/result.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace weave {

/// A file larger than this is refused by read_file unless its caller says otherwise.
inline constexpr std::uint64_t default_file_limit = std::uint64_t{512} << 20;

/// The whole content of a regular file. Errors: missing, unreadable, not a regular file, larger than `limit`
/// bytes.
Result<std::string> read_file(const std::filesystem::path& path, std::uint64_t limit = default_file_limit);

/// Writes a file whole or not at all: temporary file beside it, fsync, rename. An existing file is replaced.
Status write_file(const std::filesystem::path& path, std::string_view bytes);

/// A folder of files that appears whole or not at all. An existing `folder` that holds anything is refused.
/// Each pair is a file name without directories, and its bytes.
Status write_folder(const std::filesystem::path& folder,
                    const std::vector<std::pair<std::string, std::string>>& files);

/// The ending of a file's name in lower case, with its point: `.png` of `Card.PNG`.
std::string lower_extension(const std::filesystem::path& path);

}  // namespace weave
