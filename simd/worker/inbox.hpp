#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <simd/link/link.hpp>
#include <simd/link/work_order.hpp>
#include <string>
#include <thread>
#include <vector>

namespace weave::simd {

/// How a worker is to end.
enum class Finish : std::uint8_t {
    no,
    report,  ///< with what it has: the session was closed, the job cancelled
    keep,    ///< with its latest checkpoint written, to be taken up later
    gone,    ///< at once: there is no daemon any more
};

/// What the daemon has asked a worker for, kept by a thread of its own until the work gets to it.
class Inbox {
  public:
    using Clock = std::chrono::steady_clock;

    /// Starts to read from the link.
    explicit Inbox(Link& link);
    ~Inbox();
    Inbox(const Inbox&) = delete;
    Inbox& operator=(const Inbox&) = delete;

    /// Takes up what an order says: whether it runs, until where, and its journal.
    void begin(const WorkOrder& order);

    /// Waits until something has come since the last wait, or the time is over.
    void wait(std::optional<Clock::time_point> until);

    [[nodiscard]] Finish finish();
    /// What was granted once the plan was told: `bytes` of memory, `number` and `folder`; nothing before.
    std::optional<Json> admitted();

    /// Whether the session is to go on from this step. Steps that were asked for since count from here, and the daemon is told
    /// where they end.
    [[nodiscard]] bool goes_on(std::uint64_t step);
    /// The next change to be made before this step or later, if it is due: at its own step where it has one, else now.
    [[nodiscard]] bool change_is_due(std::uint64_t step);
    std::optional<JournaledChange> take_change(std::uint64_t step);
    /// Changes that a checkpoint has had already are no longer due.
    void skip_changes(std::uint64_t up_to);

    /// The right to compute, with so many threads; nothing while it has not been given.
    [[nodiscard]] std::optional<std::size_t> turn();
    /// Whether others wait for it.
    [[nodiscard]] bool must_yield();
    void turn_given_back();

    /// Requests for what is told of the state, as they came: `checkpoint` and `yarns`.
    std::vector<Json> take_requests();
    /// Frames wanted a second at most; 0: none.
    [[nodiscard]] double frames_per_second();
    /// Whether somebody has begun to look since the last call.
    bool take_newly_watched();

  private:
    /// So many steps from where the work is, as the daemon asked for.
    struct Steps {
        std::uint64_t count, id;
    };
    void read();
    void obey(const Json& message);

    Link& m_link;
    std::mutex m_mutex;
    std::condition_variable m_came;
    bool m_news = false;
    Finish m_finish = Finish::no;
    std::optional<Json> m_admitted;
    std::optional<std::uint64_t> m_pause_at;
    std::optional<Steps> m_steps;
    bool m_runs = false;
    std::deque<JournaledChange> m_changes;
    std::optional<std::size_t> m_turn;
    bool m_must_yield = false;
    std::vector<Json> m_requests;
    double m_frames_per_second = 0;
    bool m_newly_watched = false;
    std::thread m_thread;
};

}  // namespace weave::simd
