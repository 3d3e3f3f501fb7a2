#pragma once

#include <functional>
#include <mutex>
#include <studio/jobs/happenings.hpp>
#include <vector>

class QObject;

namespace weave::studio {

/// What a computing thread has to tell, until the window's thread has time for it. Of frames, progress and
/// yarns the newest alone waits, behind all that happened before it: who is slow misses some, and nothing piles
/// up.
class Outbox {
  public:
    /// From here on `deliver` is called in the thread of `receiver`, once for all that has come since the
    /// last call.
    void open(QObject* receiver, std::function<void()> deliver);
    /// Nobody is told any more; from the receiver's thread, before it goes.
    void close();

    /// From any thread.
    void tell(Happening happening);
    /// All that waits, oldest first; from the receiver's thread.
    [[nodiscard]] std::vector<Happening> take();

  private:
    void forget_older(Happening& newest);

    std::mutex m_mutex;
    QObject* m_receiver = nullptr;
    std::function<void()> m_deliver;
    std::vector<Happening> m_waiting;
    bool m_is_called = false;
};

}  // namespace weave::studio
