#include <weave/core/file.hpp>

#include <cctype>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <random>
#include <sys/stat.h>
#include <unistd.h>

namespace weave {

namespace {

namespace fs = std::filesystem;

/// A file descriptor that closes itself.
class Descriptor {
  public:
    explicit Descriptor(int number) : m_number(number) {}
    ~Descriptor() {
        if (m_number >= 0) ::close(m_number);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    [[nodiscard]] int number() const { return m_number; }
    int release() { return std::exchange(m_number, -1); }

  private:
    int m_number;
};

Error fault(const fs::path& path, const std::string& action) {
    return system_fault("cannot " + action + ": " + std::strerror(errno), path.string());
}

Status write_all(const Descriptor& file, std::string_view bytes, const fs::path& path) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(file.number(), bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return fault(path, "write");
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return {};
}

fs::path beside(const fs::path& path) {
    std::random_device random;
    fs::path temporary = path;
    temporary += ".part-" + std::to_string(random()) + std::to_string(random());
    return temporary;
}

Status write_new(const fs::path& path, std::string_view bytes) {
    Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.number() < 0) return fault(path, "create");
    WEAVE_CHECK_OK(write_all(file, bytes, path));
    if (::fsync(file.number()) != 0) return fault(path, "flush to disk");
    if (::close(file.release()) != 0) return fault(path, "close");
    return {};
}

void flush_parent(const fs::path& path) {
    const fs::path parent = path.has_parent_path() ? path.parent_path() : fs::path(".");
    const Descriptor folder(::open(parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (folder.number() >= 0) ::fsync(folder.number());
}

/// The place that `path` leads to, so that a symbolic link stays a link to the new content.
fs::path real_target(const fs::path& path) {
    std::error_code ignored;
    if (!fs::is_symlink(path, ignored)) return path;
    const fs::path target = fs::canonical(path, ignored);
    return target.empty() ? path : target;
}

}  // namespace

Result<std::string> read_file(const fs::path& path, std::uint64_t limit) {
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.number() < 0)
        return bad_input(std::string("cannot open: ") + std::strerror(errno), path.string());
    struct stat facts {};
    if (::fstat(file.number(), &facts) != 0) return fault(path, "examine");
    if (!S_ISREG(facts.st_mode)) return bad_input("is not a regular file", path.string());
    std::string bytes;
    bytes.reserve(std::min<std::uint64_t>(static_cast<std::uint64_t>(facts.st_size), limit) + 1);
    char buffer[1 << 16];
    while (true) {
        const ssize_t got = ::read(file.number(), buffer, sizeof buffer);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return fault(path, "read");
        if (got == 0) return bytes;
        bytes.append(buffer, static_cast<std::size_t>(got));
        if (bytes.size() > limit) {
            return bad_input("is larger than the limit of " + std::to_string(limit) + " bytes",
                             path.string());
        }
    }
}

Status write_file(const fs::path& path, std::string_view bytes) {
    const fs::path target = real_target(path);
    std::error_code ignored;
    if (fs::is_directory(target, ignored)) return system_fault("is a folder, not a file", path.string());
    if (fs::exists(target, ignored) &&
        !fs::is_regular_file(target, ignored)) {  // a device or pipe: no rename
        const Descriptor file(::open(target.c_str(), O_WRONLY | O_CLOEXEC));
        if (file.number() < 0) return fault(path, "open");
        return write_all(file, bytes, path);
    }
    const fs::path temporary = beside(target);
    Status written = write_new(temporary, bytes);
    if (written && ::rename(temporary.c_str(), target.c_str()) != 0) written = fault(path, "put into place");
    if (!written) {
        ::unlink(temporary.c_str());
        Error error = std::move(written).error();
        error.where = path.string();  // the person knows the file that was asked for, not our temporary one
        return error;
    }
    flush_parent(target);
    return {};
}

Status write_folder(const fs::path& folder, const std::vector<std::pair<std::string, std::string>>& files) {
    std::error_code code;
    fs::path target = folder;
    if (!target.has_filename()) target = target.parent_path();  // "out/" means "out"
    const bool exists = fs::exists(target, code);
    if (exists && !(fs::is_directory(target, code) && fs::is_empty(target, code))) {
        return Error{ErrorCode::refused, "exists already and is not an empty folder", folder.string()};
    }
    if (target.has_parent_path()) fs::create_directories(target.parent_path(), code);
    const fs::path temporary = beside(target);
    if (!fs::create_directory(temporary, code)) {
        return system_fault("cannot create: " + code.message(), folder.string());
    }
    Status written;
    for (const auto& [name, bytes] : files) {
        assert(fs::path(name).filename() == name);
        if (written) written = write_new(temporary / name, bytes);
    }
    if (written && ::rename(temporary.c_str(), target.c_str()) != 0)
        written = fault(folder, "put into place");
    if (!written) {
        fs::remove_all(temporary, code);
        Error error = std::move(written).error();
        error.where = folder.string();
        return error;
    }
    flush_parent(target);
    return {};
}

std::string lower_extension(const fs::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

}  // namespace weave
