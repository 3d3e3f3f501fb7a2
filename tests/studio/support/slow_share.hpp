#pragma once

#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <unistd.h>

namespace weave::studio::test {

/// A file on a share that does not answer: whoever writes it waits, until it answers.
class SlowShare {
  public:
    explicit SlowShare(const std::filesystem::path& folder) : m_path(folder / "slow.weave") { mkfifo(m_path.c_str(), 0600); }
    ~SlowShare() { answer(); }
    SlowShare(const SlowShare&) = delete;
    SlowShare& operator=(const SlowShare&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return m_path; }
    /// Takes what is written, now and later: it stays open while the tests run.
    void answer() {
        if (m_end < 0) m_end = open(m_path.c_str(), O_RDWR | O_CLOEXEC);
    }

  private:
    std::filesystem::path m_path;
    int m_end = -1;
};

}  // namespace weave::studio::test
