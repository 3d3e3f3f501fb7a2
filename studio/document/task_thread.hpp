#pragma once

#include <QObject>
#include <QThread>

#include <functional>
#include <utility>

namespace weave::studio {

/// A thread that does what it is asked for, one thing after the other.
class TaskThread {
  public:
    TaskThread() {
        m_here.moveToThread(&m_thread);
        m_thread.start();
    }
    /// Does what it was asked for first.
    ~TaskThread() {
        flush();
        m_thread.quit();
        m_thread.wait();
    }
    TaskThread(const TaskThread&) = delete;
    TaskThread& operator=(const TaskThread&) = delete;

    void ask(std::function<void()> task) {
        QMetaObject::invokeMethod(&m_here, std::move(task), Qt::QueuedConnection);
    }
    /// Waits until all that was asked for is done.
    void flush() {
        QMetaObject::invokeMethod(&m_here, [] {}, Qt::BlockingQueuedConnection);
    }

  private:
    QThread m_thread;
    QObject m_here;
};

}  // namespace weave::studio
