#include <weave/keys/private_file.hpp>

#include <weave/core/descriptor.hpp>
#include <weave/core/file.hpp>
#include <weave/core/log.hpp>
#include <weave/core/text.hpp>
#include <weave/keys/hex.hpp>
#include <weave/keys/sodium.hpp>

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

namespace weave {

namespace {

namespace fs = std::filesystem;

Error refused(const fs::path& path, std::string why) {
    return {ErrorCode::refused, std::move(why), path.string()};
}

fs::path temporary_beside(const fs::path& path) {
    need_sodium();
    unsigned char random[8];
    randombytes_buf(random, sizeof random);
    return path.parent_path() / (".weave-part-" + to_hex(random));
}

/// Removes a temporary file when it goes.
class Litter {
  public:
    explicit Litter(fs::path path) : m_path(std::move(path)) {}
    ~Litter() { ::unlink(m_path.c_str()); }
    Litter(const Litter&) = delete;
    Litter& operator=(const Litter&) = delete;

  private:
    fs::path m_path;
};

Status write_new(const fs::path& temporary, std::string_view bytes) {
    Descriptor file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600));
    if (file.number() < 0) return file_fault(temporary, "create");
    WEAVE_CHECK_OK(write_all(file, bytes, temporary));
    if (::fsync(file.number()) != 0) return file_fault(temporary, "flush to disk");
    if (::close(file.release()) != 0) return file_fault(temporary, "close");
    return {};
}

void flush_folder(const fs::path& path) {
    const Descriptor folder(::open(path.empty() ? "." : path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (folder.number() >= 0) ::fsync(folder.number());
}

Status check_facts(const struct stat& facts, const fs::path& path) {
    if (!S_ISREG(facts.st_mode)) return refused(path, "is not a regular file");
    if (facts.st_uid != ::geteuid()) return refused(path, "belongs to another user of this system");
    if ((facts.st_mode & 077) != 0)
        return refused(path, "may be read or written by others; its mode must be 0600 (chmod 600)");
    return {};
}

/// Opens a file after it was found to be private.
Result<int> open_private(const fs::path& path, struct stat& facts) {
    Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
    if (file.number() < 0 && errno == ELOOP) return refused(path, "is a symbolic link");
    if (file.number() < 0)
        return bad_input(std::string("cannot open: ") + std::strerror(errno), path.string());
    if (::fstat(file.number(), &facts) != 0) return file_fault(path, "examine");
    WEAVE_CHECK_OK(check_facts(facts, path));
    return file.release();
}

}  // namespace

Status create_private_file(const fs::path& path, std::string_view bytes) {
    const fs::path temporary = temporary_beside(path);
    const Litter litter(temporary);
    if (Status written = write_new(temporary, bytes); !written) {
        Error error = std::move(written).error();
        error.where = path.string();
        return error;
    }
    // A link, unlike a rename, never replaces what is there.
    if (::link(temporary.c_str(), path.c_str()) != 0) {
        if (errno == EEXIST) return refused(path, "exists already");
        return file_fault(path, "put into place");
    }
    flush_folder(path.parent_path());
    return {};
}

Status write_private_file(const fs::path& path, std::string_view bytes) {
    std::error_code code;
    if (!fs::exists(fs::symlink_status(path, code))) return create_private_file(path, bytes);
    WEAVE_CHECK_OK(check_private_file(path));
    return write_file(path, bytes);  // which keeps the mode
}

Status check_private_file(const fs::path& path) {
    struct stat facts {};
    WEAVE_TRY(const int number, open_private(path, facts));
    ::close(number);
    return {};
}

void warn_if_not_private(const fs::path& path) {
    struct stat facts {};
    if (::stat(path.c_str(), &facts) != 0 || !S_ISREG(facts.st_mode) || (facts.st_mode & 077) == 0) return;
    log(LogLevel::warning, on_one_line(path.string()) + ": others may read or write it; what it holds is yours alone (chmod 600)");
}

Result<SecretBytes> read_private_file(const fs::path& path, std::size_t limit) {
    struct stat facts {};
    WEAVE_TRY(const int number, open_private(path, facts));
    const Descriptor file(number);
    if (facts.st_size < 0 || static_cast<std::size_t>(facts.st_size) > limit)
        return bad_input("is larger than the limit of " + std::to_string(limit) + " bytes", path.string());
    SecretBytes bytes(static_cast<std::size_t>(facts.st_size));
    for (std::size_t at = 0; at < bytes.size();) {
        const ssize_t got = ::read(file.number(), bytes.data() + at, bytes.size() - at);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return file_fault(path, "read");
        if (got == 0) return system_fault("became shorter while it was read", path.string());
        at += static_cast<std::size_t>(got);
    }
    return bytes;
}

}  // namespace weave
