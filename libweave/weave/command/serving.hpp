#pragma once

#include <weave/core/descriptor.hpp>
#include <weave/core/result.hpp>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>

namespace weave {

/// What programs that serve have in common: they log to standard error, end by a signal, and have their folder to themselves.

/// One line an event, with the time it happened (UTC).
void log_to_stderr();

/// The signals that end a service (SIGINT, SIGTERM): from now on they wait, in every thread that is started later too.
class EndingSignals {
  public:
    EndingSignals();
    /// Waits for one of them.
    void wait() const;
    /// The same for so long at most; whether one came.
    [[nodiscard]] bool wait(std::chrono::milliseconds most) const;

  private:
    sigset_t m_signals{};
};

/// Keeps other programs from serving the same folder, for as long as it lives.
class FolderLock {
  public:
    /// Refused: another one has it. `who` names the program for people.
    static Result<FolderLock> take(const std::filesystem::path& folder, const std::string& who);

  private:
    explicit FolderLock(Descriptor file) : m_file(std::move(file)) {}
    Descriptor m_file;
};

/// Makes the folder of a service where it is missing (mode 0700). Not those above it: a name that was mistyped would make one
/// where nobody looks for it.
Status make_service_folder(const std::filesystem::path& folder);

/// Whether it is there, or could be made so.
Status check_service_folder(const std::filesystem::path& folder);

}  // namespace weave
