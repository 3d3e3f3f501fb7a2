#pragma once

#include <weave/core/result.hpp>

#include <filesystem>
#include <sys/un.h>

namespace weave::net {

/// The address of a Unix socket of that path. Errors (usage): a path that is empty, has a NUL in it, or is
/// longer than the 107 bytes that a socket's address has room for.
Result<sockaddr_un> unix_address(const std::filesystem::path& path);

/// A Unix socket that listens, and its file, which goes away with it.
class UnixListener {
  public:
    /// Makes the socket, open to its owner alone (0600) before anybody can connect, and listens. The socket
    /// of a server that is dead is replaced. Errors: usage for a path that is none; refused where another
    /// server listens, or something else lies there; system.
    static Result<UnixListener> open(const std::filesystem::path& path);

    UnixListener(UnixListener&& other) noexcept;
    UnixListener& operator=(UnixListener&&) = delete;
    /// Removes the file and closes the socket if it was not taken.
    ~UnixListener();

    /// Hands the listening socket, which does not block, over to the caller. The file stays the listener's.
    [[nodiscard]] int take_socket();
    /// Removes the file, if it is still that of this socket. Only while the socket listens: afterwards the
    /// next server may take the place at any moment.
    void remove_file();

  private:
    explicit UnixListener(int socket) : m_socket(socket) {}
    Status listen(const std::filesystem::path& path, const sockaddr_un& address);

    int m_socket;
    std::filesystem::path m_file;  ///< absolute; empty: there is none of ours
    dev_t m_device = 0;
    ino_t m_inode = 0;
};

}  // namespace weave::net
