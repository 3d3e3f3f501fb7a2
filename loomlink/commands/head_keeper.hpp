#pragma once

#include <weave/core/result.hpp>

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <loomlink/audit/head.hpp>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>

namespace weave::loomlink {

/// Keeps the signed heads of a log in a second place, best on another machine: whoever rewrites the whole log,
/// with the server's key at hand, is found out by it (`verify --retained`). A line a head, each flushed to the
/// disk: every `pause` while the log grows, and at the end. Nothing is ever taken from the file. What could
/// not be written is a warning, and status() until it can be.
class HeadKeeper {
  public:
    /// Errors: a file that cannot be added to.
    static Result<std::unique_ptr<HeadKeeper>> start(std::filesystem::path file,
                                                     std::function<Result<SignedTreeHead>()> newest,
                                                     std::chrono::milliseconds pause = std::chrono::minutes(1));
    ~HeadKeeper();
    HeadKeeper(const HeadKeeper&) = delete;
    HeadKeeper& operator=(const HeadKeeper&) = delete;

    /// How the last attempt went.
    [[nodiscard]] Status status() const;

  private:
    HeadKeeper(std::filesystem::path file, std::function<Result<SignedTreeHead>()> newest,
               std::chrono::milliseconds pause);
    void work(const std::stop_token& stop);
    void keep_newest();

    std::filesystem::path m_file;
    std::function<Result<SignedTreeHead>()> m_newest;
    std::chrono::milliseconds m_pause;
    std::uint64_t m_kept = 0;  ///< records of the head that was written last
    mutable std::mutex m_mutex;
    std::condition_variable_any m_wake;
    Status m_status;
    std::jthread m_thread;  ///< last, so that it ends first
};

/// The newest head of a file that a HeadKeeper or `audit head -o` wrote; a last line that was cut off does not
/// count. Errors name the file.
Result<SignedTreeHead> load_retained_head(const std::filesystem::path& file);

}  // namespace weave::loomlink
