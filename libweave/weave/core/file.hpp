#pragma once

#include <weave/core/result.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
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

/// Writes a file whole or not at all, whenever the power fails: a temporary file beside it is flushed to disk, put
/// into place, and then its folder is flushed. A device or a pipe is written to as it is. An existing file is replaced
/// and keeps its permissions and, where the system allows it, its owner. A symbolic link stays one: its
/// target is written, and made if it is missing. Refused: a file that is write-protected, be it for all (root
/// as well). The log is told where another name (hard link) keeps the old content, or the owner could not be
/// kept.
Status write_file(const std::filesystem::path& path, std::string_view bytes);

/// A file that is written piece by piece, for what is too long to be held at once; it is in place once finish() was called, and
/// until then, or where anything fails, what was there stays. As write_file(), but for devices and pipes, which are refused.
class FileInPieces {
  public:
    static Result<FileInPieces> begin(const std::filesystem::path& path);
    FileInPieces(FileInPieces&&) noexcept;
    FileInPieces& operator=(FileInPieces&&) noexcept;
    ~FileInPieces();

    /// Writes from this byte of the file on; what is never written is zero.
    Status write(std::uint64_t from, std::string_view bytes);
    Status finish();

  private:
    struct Parts;
    explicit FileInPieces(std::unique_ptr<Parts> parts);
    std::unique_ptr<Parts> m_parts;
};

/// Whether write_file() could write there, as far as that shows beforehand: for what is written only after long work.
Status check_writable(const std::filesystem::path& path);

/// A folder of files that appears whole or not at all: each file and then the folder is flushed to disk before it is
/// put into place. Refused: a `folder` that exists and holds anything, is
/// the current one, or is a mount point. A symbolic link to an empty folder stays one. Each pair is a file
/// name without directories, and its bytes. Folders above it are made, and removed again on failure.
Status write_folder(const std::filesystem::path& folder,
                    const std::vector<std::pair<std::string, std::string>>& files);

/// Removes the temporary files and folders of every write that is under way, for a program that is being
/// ended. Writers wait from then on, for ever: end the process next. To be called from an ordinary thread,
/// such as one in sigwait, not from a signal handler.
void drop_unfinished_writes();

/// The ending of a file's name in lower case, with its point: `.png` of `Card.PNG`.
std::string lower_extension(const std::filesystem::path& path);

}  // namespace weave
