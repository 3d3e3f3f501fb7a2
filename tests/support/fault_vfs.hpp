#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <sqlite3.h>
#include <string>

namespace weave::testing {

/// What goes wrong at the chosen call.
enum class DiskFault { none, full, io_error, short_write, power_loss };

/// A disk under SQLite that fails when told to. It stands between SQLite and the system's own VFS for as long
/// as it lives, for everything that opens a database meanwhile. It remembers what was flushed: at a power
/// loss, each 512-byte sector written since its file's last flush is kept or dropped at random, and so is
/// what changed of the file's length.
class FaultDisk {
  public:
    /// `forget_full`: connections get synchronous=NORMAL whatever they ask for.
    explicit FaultDisk(bool forget_full = false);
    ~FaultDisk();
    FaultDisk(const FaultDisk&) = delete;
    FaultDisk& operator=(const FaultDisk&) = delete;

    /// Lets the call number `at` from now (1 is the next) of all writes, truncations and flushes fail so.
    void plan(DiskFault fault, std::uint64_t at, std::uint64_t seed = 0);
    /// Whether what was planned has happened.
    [[nodiscard]] bool happened() const;
    /// Loses power now, if it was not lost yet.
    void cut_power();
    /// After a power loss, once nothing has a file open: puts on the real disk what the lost power left, and
    /// the power is back.
    void restore_power();

    class File;  // SQLite's view of one open file
    int write(File& file, const void* data, int count, sqlite3_int64 offset);
    int truncate(File& file, sqlite3_int64 size);
    int sync(File& file, int flags);
    int remove(const std::string& path, int flags, sqlite3_vfs* real);
    [[nodiscard]] bool forgets_full() const { return m_forget_full; }
    void opened(const std::string& path, sqlite3_file* real);

  private:
    /// A file as the last flush left it, and the sectors written since.
    struct Image {
        std::string flushed;
        std::set<std::int64_t> dirty;
        std::string after_loss;
    };
    static constexpr std::int64_t sector = 512;

    DiskFault next_call();
    void lose_power();
    static std::string content_of(sqlite3_file* real);

    mutable std::mutex m_mutex;
    std::map<std::string, Image> m_images;
    std::map<std::string, std::set<sqlite3_file*>> m_open;
    DiskFault m_fault = DiskFault::none;
    std::uint64_t m_calls = 0;
    std::uint64_t m_at = 0;
    bool m_happened = false;
    bool m_dark = false;  ///< power is lost
    bool m_forget_full;
    std::mt19937_64 m_random;

  public:
    void closed(const std::string& path, sqlite3_file* real);
};

}  // namespace weave::testing
