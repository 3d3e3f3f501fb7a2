#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace weave::program {

/// Tells on standard error what is being done and for how long, once it takes over a second; ends with its
/// scope.
class Progress {
  public:
    explicit Progress(const std::string& doing);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

  private:
    void tell();
    std::string m_doing;
    std::mutex m_mutex;
    std::condition_variable m_ended;
    bool m_over = false;
    std::thread m_thread;
};

}  // namespace weave::program
