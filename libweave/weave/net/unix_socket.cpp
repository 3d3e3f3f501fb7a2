#include <weave/net/unix_socket.hpp>

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace weave::net {

namespace {

constexpr int turn_tries = 100;
constexpr useconds_t turn_pause = 50'000;  // µs: 5 s in all, while another server starts in the same folder

std::string in_words(int error) {
    return std::generic_category().message(error);
}

Error cannot_listen(const std::filesystem::path& path, int error) {
    return system_fault("cannot listen: " + in_words(error), path.string());
}

/// A descriptor that is closed with its scope.
class Descriptor {
  public:
    explicit Descriptor(int number) : m_number(number) {}
    ~Descriptor() {
        if (m_number >= 0) ::close(m_number);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    [[nodiscard]] int number() const { return m_number; }

  private:
    int m_number;
};

int stream_socket() {
    return ::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
}

/// Two servers that found the same dead socket could each replace it, the second the living one of the first:
/// so one starts after the other.
Status wait_for_turn(const Descriptor& folder, const std::filesystem::path& path) {
    if (folder.number() < 0) return system_fault("cannot open its folder: " + in_words(errno), path.string());
    for (int k = 0; k < turn_tries; ++k) {
        if (::flock(folder.number(), LOCK_EX | LOCK_NB) == 0) return {};
        if (errno != EWOULDBLOCK && errno != EINTR) return cannot_listen(path, errno);
        ::usleep(turn_pause);
    }
    return system_fault("another program keeps its folder locked", path.string());
}

/// Removes the socket of a dead server, and nothing else.
Status make_room(const std::filesystem::path& path, const sockaddr_un& address) {
    struct stat facts {};
    if (::lstat(path.c_str(), &facts) != 0)
        return errno == ENOENT ? Status() : Status(cannot_listen(path, errno));
    if (!S_ISSOCK(facts.st_mode))
        return Error{ErrorCode::refused, "something that is no socket lies there", path.string()};
    const Descriptor probe(stream_socket());
    if (probe.number() < 0) return cannot_listen(path, errno);
    const auto* const place = reinterpret_cast<const sockaddr*>(&address);
    const int failed = ::connect(probe.number(), place, sizeof address) == 0 ? 0 : errno;
    if (failed == 0 || failed == EAGAIN)  // EAGAIN: so many clients wait there
        return Error{ErrorCode::refused, "another server listens there", path.string()};
    if (failed != ECONNREFUSED) return cannot_listen(path, failed);
    if (::unlink(path.c_str()) != 0 && errno != ENOENT) return cannot_listen(path, errno);
    return {};
}

}  // namespace

Result<sockaddr_un> unix_address(const std::filesystem::path& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string& text = path.native();
    if (text.empty() || text.find('\0') != std::string::npos)
        return Error{ErrorCode::usage, "is no path of a socket", text.substr(0, text.find('\0'))};
    if (text.size() >= sizeof address.sun_path)
        return Error{ErrorCode::usage,
                     "the path of a socket may have " + std::to_string(sizeof address.sun_path - 1) +
                         " bytes, this one has " + std::to_string(text.size()),
                     text};
    std::memcpy(address.sun_path, text.data(), text.size());
    return address;
}

Result<UnixListener> UnixListener::open(const std::filesystem::path& path) {
    WEAVE_TRY(const sockaddr_un address, unix_address(path));
    UnixListener listener(stream_socket());
    if (listener.m_socket < 0) return cannot_listen(path, errno);
    std::error_code error;
    const std::filesystem::path whole = std::filesystem::absolute(path, error);
    if (error) return cannot_listen(path, error.value());
    const Descriptor folder(::open(whole.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    WEAVE_CHECK_OK(wait_for_turn(folder, path));
    WEAVE_CHECK_OK(make_room(path, address));
    WEAVE_CHECK_OK(listener.listen(whole, address));
    return listener;
}

Status UnixListener::listen(const std::filesystem::path& path, const sockaddr_un& address) {
    if (::bind(m_socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        return cannot_listen(path, errno);
    m_file = path;
    struct stat facts {};
    if (::lstat(path.c_str(), &facts) != 0) return cannot_listen(path, errno);
    m_device = facts.st_dev;
    m_inode = facts.st_ino;
    // Nobody can connect before the socket listens, so its first mode, which the umask gave it, matters not.
    if (::fchmodat(AT_FDCWD, path.c_str(), S_IRUSR | S_IWUSR, AT_SYMLINK_NOFOLLOW) != 0)
        return cannot_listen(path, errno);
    if (::listen(m_socket, SOMAXCONN) != 0) return cannot_listen(path, errno);
    return {};
}

UnixListener::UnixListener(UnixListener&& other) noexcept
    : m_socket(std::exchange(other.m_socket, -1)),
      m_file(std::exchange(other.m_file, {})),
      m_device(other.m_device),
      m_inode(other.m_inode) {}

UnixListener::~UnixListener() {
    remove_file();
    if (m_socket >= 0) ::close(m_socket);
}

int UnixListener::take_socket() {
    return std::exchange(m_socket, -1);
}

void UnixListener::remove_file() {
    struct stat facts {};
    const bool ours = !m_file.empty() && ::lstat(m_file.c_str(), &facts) == 0 && facts.st_dev == m_device &&
                      facts.st_ino == m_inode;
    if (ours) ::unlink(m_file.c_str());
    m_file.clear();
}

}  // namespace weave::net
