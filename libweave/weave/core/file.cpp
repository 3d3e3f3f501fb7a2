#include <weave/core/file.hpp>

#include <weave/core/descriptor.hpp>
#include <weave/core/log.hpp>

#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <mutex>
#include <optional>
#include <random>
#include <sys/stat.h>
#include <unistd.h>

namespace weave {

namespace {

namespace fs = std::filesystem;

/// What is being made and would be litter if the program ended now: temporary files and folders, and folders
/// that were made to hold them. Everything is made under the lock, so that drop_unfinished_writes() misses
/// nothing.
struct Unfinished {
    std::mutex mutex;
    std::vector<fs::path> places;
};

Unfinished& unfinished() {
    static auto* const one = new Unfinished;  // outlives every thread
    return *one;
}

/// Removes what was made through it, the last first, unless keep() is called. Each thing is noted by itself,
/// so that no folder is removed with anything in it that is not ours.
class Scaffold {
  public:
    Scaffold() = default;
    ~Scaffold() {
        std::error_code ignored;
        for (auto place = m_places.rbegin(); place != m_places.rend(); ++place) fs::remove(*place, ignored);
        keep();
    }
    Scaffold(const Scaffold&) = delete;
    Scaffold& operator=(const Scaffold&) = delete;

    /// Runs `make`, which tells whether it made `place`.
    template <class Make>
    bool make(const fs::path& place, Make make) {
        const std::lock_guard lock(unfinished().mutex);
        if (!make()) return false;
        m_places.push_back(place);
        unfinished().places.push_back(place);
        return true;
    }
    void keep() {
        const std::lock_guard lock(unfinished().mutex);
        for (const fs::path& place : m_places) std::erase(unfinished().places, place);
        m_places.clear();
    }

  private:
    std::vector<fs::path> m_places;
};

fs::path temporary_beside(const fs::path& path) {
    std::random_device random;
    return path.parent_path() /
           (".weave-part-" + std::to_string(random()));  // short, however long the name is
}

constexpr mode_t usual_mode = 0666;  // less what the umask takes

/// A new file; `like` gives owner and permissions once it is complete.
Result<Descriptor> create(Scaffold& scaffold, const fs::path& path, const struct stat* like) {
    const mode_t mode = like == nullptr ? usual_mode : 0600;
    int number = -1;
    const auto open = [&] {
        return (number = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode)) >= 0;
    };
    if (!scaffold.make(path, open)) return file_fault(path, "create");
    return Descriptor(number);
}

Status complete(Descriptor& file, const fs::path& path, const struct stat* like) {
    if (like != nullptr) {
        static_cast<void>(!::fchown(file.number(), like->st_uid, like->st_gid));  // told once it is in place
        if (::fchmod(file.number(), like->st_mode & 0777) != 0) return file_fault(path, "set the permissions");
    }
    if (::fsync(file.number()) != 0) return file_fault(path, "flush to disk");
    if (::close(file.release()) != 0) return file_fault(path, "close");
    return {};
}

/// A new file with these bytes, flushed.
Status write_new(Scaffold& scaffold, const fs::path& path, std::string_view bytes,
                 const struct stat* like = nullptr) {
    WEAVE_TRY(Descriptor file, create(scaffold, path, like));
    WEAVE_CHECK_OK(write_all(file, bytes, path));
    return complete(file, path, like);
}

/// Flushes the names in a folder. Some file systems cannot, and need not.
void flush_folder(const fs::path& path) {
    const Descriptor folder(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (folder.number() >= 0) ::fsync(folder.number());
}

void flush_parent(const fs::path& path) {
    flush_folder(path.has_parent_path() ? path.parent_path() : fs::path("."));
}

/// The place that `path` leads to, whether anything is there or not, so that a symbolic link stays one.
Result<fs::path> real_target(const fs::path& path) {
    constexpr int most_links = 40;  // as the system itself
    fs::path target = path;
    std::error_code code;
    for (int k = 0; fs::is_symlink(target, code); ++k) {
        if (k == most_links) return system_fault("is a loop of symbolic links", path.string());
        const fs::path next = fs::read_symlink(target, code);
        if (code) return system_fault("cannot follow the link: " + code.message(), path.string());
        target = target.parent_path() / next;  // an absolute `next` stands alone
    }
    return target;
}

/// While it lives, a pipe that nobody reads any more gives an error in this thread and does not end the
/// program.
class BrokenPipesHeld {
  public:
    BrokenPipesHeld() {
        sigemptyset(&m_pipe);
        sigaddset(&m_pipe, SIGPIPE);
        ::pthread_sigmask(SIG_BLOCK, &m_pipe, &m_before);
    }
    ~BrokenPipesHeld() {
        constexpr timespec now{0, 0};
        if (sigismember(&m_before, SIGPIPE) == 0)
            ::sigtimedwait(&m_pipe, nullptr, &now);  // what came is done with
        ::pthread_sigmask(SIG_SETMASK, &m_before, nullptr);
    }
    BrokenPipesHeld(const BrokenPipesHeld&) = delete;
    BrokenPipesHeld& operator=(const BrokenPipesHeld&) = delete;

  private:
    sigset_t m_pipe{}, m_before{};
};

Status write_through(const fs::path& path, std::string_view bytes) {
    const Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
    if (file.number() < 0) return file_fault(path, "open");
    const BrokenPipesHeld held;
    return write_all(file, bytes, path);
}

Status check_replaceable(const fs::path& target, const struct stat& old, const fs::path& path) {
    const bool protected_for_all = (old.st_mode & 0222) == 0;
    if (!protected_for_all && ::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) == 0) return {};
    return Error{ErrorCode::refused, "is write-protected", path.string()};
}

/// Where a file is written, and what is there.
struct Destination {
    fs::path target;
    struct stat old {};
    bool exists = false;
    /// A device or pipe: no rename. The name of a pipe in /proc is a link to no place, and leads there all the same.
    bool is_through = false;
};

/// Refused: a folder, and a file that is write-protected.
Result<Destination> destination_of(const fs::path& path) {
    Destination to;
    to.exists = ::stat(path.c_str(), &to.old) == 0;
    if (to.exists && S_ISDIR(to.old.st_mode)) return system_fault("is a folder, not a file", path.string());
    to.is_through = to.exists && !S_ISREG(to.old.st_mode);
    if (to.is_through) return to;
    WEAVE_TRY(to.target, real_target(path));
    if (to.exists) WEAVE_CHECK_OK(check_replaceable(to.target, to.old, path));
    return to;
}

/// What a replaced file lost that nothing could keep.
void tell_changes(const fs::path& target, const struct stat& old, const fs::path& path) {
    if (old.st_nlink > 1)
        log(LogLevel::warning,
            path.string() + ": another name of this file (hard link) keeps the old content");
    struct stat now {};
    if (::stat(target.c_str(), &now) == 0 && (now.st_uid != old.st_uid || now.st_gid != old.st_gid))
        log(LogLevel::warning,
            path.string() + ": does not belong to the owner or group of the old file any more");
}

/// An error as the person sees it: the file that was asked for, not our temporary one.
Status seen_from(Status status, const fs::path& path) {
    if (status) return status;
    Error error = std::move(status).error();
    error.where = path.string();
    return error;
}

Error refused(const fs::path& folder, const char* why) {
    return {ErrorCode::refused, why, folder.string()};
}

Error taken(const fs::path& folder) {
    return refused(folder, "exists already and is not an empty folder");
}

/// The real place of a folder to write. Refused where it is taken.
Result<fs::path> free_folder(const fs::path& folder) {
    fs::path plain = folder;
    if (!plain.has_filename()) plain = plain.parent_path();  // "out/" means "out"
    WEAVE_TRY(const fs::path linked, real_target(plain));
    std::error_code code;
    fs::path target = fs::weakly_canonical(linked, code);
    if (code) return system_fault("cannot create: " + code.message(), folder.string());
    if (!fs::exists(target, code)) return target;
    if (!fs::is_directory(target, code) || !fs::is_empty(target, code)) return taken(folder);
    if (fs::equivalent(target, fs::current_path(code), code))
        return refused(folder, "is the folder in which you are, which cannot be replaced; name another one");
    return target;
}

/// Makes the folders above `target`, each noted.
Status make_parents(Scaffold& scaffold, const fs::path& target) {
    std::vector<fs::path> missing;
    std::error_code code;
    for (fs::path parent = target.parent_path(); !parent.empty() && !fs::exists(parent, code);
         parent = parent.parent_path())
        missing.push_back(parent);
    for (auto parent = missing.rbegin(); parent != missing.rend(); ++parent) {
        const bool made = scaffold.make(*parent, [&] { return fs::create_directory(*parent, code); });
        if (!made && code) return system_fault("cannot create: " + code.message());
    }
    return {};
}

/// All of write_folder() but the last step.
Status write_beside(Scaffold& scaffold, const fs::path& temporary,
                    const std::vector<std::pair<std::string, std::string>>& files) {
    std::error_code code;
    if (!scaffold.make(temporary, [&] { return fs::create_directory(temporary, code); }))
        return system_fault("cannot create: " + code.message());
    for (const auto& [name, bytes] : files) {
        assert(fs::path(name).filename() == name);
        WEAVE_CHECK_OK(write_new(scaffold, temporary / name, bytes));
    }
    flush_folder(temporary);  // so that no name is missing once it is in place
    return {};
}

}  // namespace

Result<std::string> read_file(const fs::path& path, std::uint64_t limit) {
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.number() < 0)
        return bad_input(std::string("cannot open: ") + std::strerror(errno), path.string());
    struct stat facts {};
    if (::fstat(file.number(), &facts) != 0) return file_fault(path, "examine");
    if (!S_ISREG(facts.st_mode)) return bad_input("is not a regular file", path.string());
    const auto too_large = [&] {
        return bad_input("is larger than the limit of " + std::to_string(limit) + " bytes", path.string());
    };
    if (static_cast<std::uint64_t>(facts.st_size) > limit) return too_large();  // without reading it first
    std::string bytes;
    bytes.reserve(static_cast<std::size_t>(facts.st_size) + 1);
    char buffer[1 << 16];
    while (true) {
        const ssize_t got = ::read(file.number(), buffer, sizeof buffer);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return file_fault(path, "read");
        if (got == 0) return bytes;
        bytes.append(buffer, static_cast<std::size_t>(got));
        if (bytes.size() > limit) return too_large();  // it grew meanwhile, or its size is not told
    }
}

namespace {

Status put_into_place(Scaffold& scaffold, const fs::path& temporary, const Destination& to, const fs::path& path) {
    if (::rename(temporary.c_str(), to.target.c_str()) != 0) return file_fault(path, "put into place");
    scaffold.keep();
    flush_parent(to.target);
    if (to.exists) tell_changes(to.target, to.old, path);
    return {};
}

}  // namespace

Status write_file(const fs::path& path, std::string_view bytes) {
    WEAVE_TRY(const Destination to, destination_of(path));
    if (to.is_through) return write_through(path, bytes);
    Scaffold scaffold;
    const fs::path temporary = temporary_beside(to.target);
    WEAVE_CHECK_OK(seen_from(write_new(scaffold, temporary, bytes, to.exists ? &to.old : nullptr), path));
    return put_into_place(scaffold, temporary, to, path);
}

struct FileInPieces::Parts {
    fs::path path;
    Destination to;
    fs::path temporary;
    Scaffold scaffold;
    std::optional<Descriptor> file;
};

FileInPieces::FileInPieces(std::unique_ptr<Parts> parts) : m_parts(std::move(parts)) {}
FileInPieces::FileInPieces(FileInPieces&&) noexcept = default;
FileInPieces& FileInPieces::operator=(FileInPieces&&) noexcept = default;
FileInPieces::~FileInPieces() = default;

Result<FileInPieces> FileInPieces::begin(const fs::path& path) {
    auto parts = std::make_unique<Parts>();
    parts->path = path;
    WEAVE_TRY(parts->to, destination_of(path));
    if (parts->to.is_through) return system_fault("is a device or a pipe, which is not written in pieces", path.string());
    parts->temporary = temporary_beside(parts->to.target);
    auto file = create(parts->scaffold, parts->temporary, parts->to.exists ? &parts->to.old : nullptr);
    if (!file) return seen_from(std::move(file).error(), path).error();
    parts->file.emplace(std::move(*file));
    return FileInPieces(std::move(parts));
}

Status FileInPieces::write(std::uint64_t from, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t put = ::pwrite(m_parts->file->number(), bytes.data(), bytes.size(), static_cast<off_t>(from));
        if (put < 0 && errno == EINTR) continue;
        if (put < 0) return file_fault(m_parts->path, "write");
        bytes.remove_prefix(static_cast<std::size_t>(put));
        from += static_cast<std::uint64_t>(put);
    }
    return {};
}

Status FileInPieces::finish() {
    const Parts& parts = *m_parts;
    WEAVE_CHECK_OK(seen_from(complete(*m_parts->file, parts.temporary, parts.to.exists ? &parts.to.old : nullptr), parts.path));
    return put_into_place(m_parts->scaffold, parts.temporary, parts.to, parts.path);
}

Status check_writable(const fs::path& path) {
    WEAVE_TRY(const Destination to, destination_of(path));
    if (to.is_through) return {};
    const fs::path folder = to.target.has_parent_path() ? to.target.parent_path() : fs::path(".");
    const fs::path within = folder / ".";  // which is in no file
    if (::faccessat(AT_FDCWD, within.c_str(), W_OK | X_OK, AT_EACCESS) != 0) return file_fault(path, "create");
    return {};
}

Status write_folder(const fs::path& folder, const std::vector<std::pair<std::string, std::string>>& files) {
    WEAVE_TRY(const fs::path target, free_folder(folder));
    Scaffold scaffold;
    WEAVE_CHECK_OK(seen_from(make_parents(scaffold, target), folder));
    const fs::path temporary = temporary_beside(target);
    WEAVE_CHECK_OK(seen_from(write_beside(scaffold, temporary, files), folder));
    if (::rename(temporary.c_str(), target.c_str()) != 0) {
        if (errno == ENOTEMPTY || errno == EEXIST || errno == ENOTDIR) return taken(folder);  // by now
        if (errno != EBUSY) return file_fault(folder, "put into place");
        return refused(folder, "is in use or a mount point; name a folder that does not exist");
    }
    scaffold.keep();
    flush_parent(target);
    return {};
}

void drop_unfinished_writes() {
    unfinished().mutex.lock();  // and never unlocked: nothing is begun any more
    const std::vector<fs::path>& places = unfinished().places;
    std::error_code ignored;
    for (auto place = places.rbegin(); place != places.rend(); ++place) fs::remove(*place, ignored);
}

std::string lower_extension(const fs::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

}  // namespace weave
