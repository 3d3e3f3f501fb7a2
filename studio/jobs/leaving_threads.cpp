#include <studio/jobs/leaving_threads.hpp>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <malloc.h>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

namespace weave::studio {

namespace {

constexpr std::chrono::seconds at_the_end{2};

/// Counts threads that run; it lives until the last of them has ended, be that after the program's own end.
struct Count {
    std::mutex mutex;
    std::condition_variable changed;
    std::size_t running = 0;

    void change(bool begins) {
        const std::lock_guard lock(mutex);
        running += begins ? 1 : std::size_t(-1);
        changed.notify_all();
    }
};

class LastOnes {
  public:
    LastOnes() = default;
    ~LastOnes() {
        std::unique_lock lock(count->mutex);
        count->changed.wait_for(lock, at_the_end, [this] { return count->running == 0; });
    }
    LastOnes(const LastOnes&) = delete;
    LastOnes& operator=(const LastOnes&) = delete;

    const std::shared_ptr<Count> count = std::make_shared<Count>();
};

}  // namespace

void return_freed_memory() {
#ifdef __GLIBC__
    ::malloc_trim(0);
#endif
}

void run_apart(std::function<void()> work) {
    static const LastOnes last_ones;
    const std::shared_ptr<Count> count = last_ones.count;
    count->change(true);
    std::thread([count, work = std::move(work)]() mutable {
        work();
        work = {};  // what it held goes before it counts as ended
        count->change(false);
    }).detach();
}

}  // namespace weave::studio
