#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace weave::simd {

/// Who computes when. A worker that wants to compute asks for a turn and keeps it until it is asked back, which happens once
/// others have waited for a quantum. People share the machine evenly, whatever number of sessions and jobs each has; of one
/// person's own, sessions go before jobs four times out of five. The threads of the machine are spread over those that want to
/// compute. Safe from any thread, and waits for nobody: who computes next must not depend on who has the daemon's lock.
class Turns {
  public:
    using Clock = std::chrono::steady_clock;
    using Id = std::uint64_t;

    struct Rules {
        std::size_t threads = 1;              ///< of the machine, at least 1
        std::chrono::milliseconds quantum{50};
        /// A worker that does not give its turn back for so long after it was asked no longer keeps others waiting.
        std::chrono::milliseconds patience{1000};
    };
    /// What workers are told: `give(id, threads)` a turn, `ask_back(id)`. Neither may wait, nor call what is below.
    struct Tell {
        std::function<void(Id, std::size_t)> give;
        std::function<void(Id)> ask_back;
    };

    Turns(const Rules& rules, Tell tell) : m_rules(rules), m_tell(std::move(tell)) {}

    void add(Id id, const std::string& person, bool is_job);
    /// The worker wants to compute.
    void want(Id id, Clock::time_point now);
    /// It has given its turn back, or wants none any more.
    void over(Id id, Clock::time_point now);
    /// It has given its turn back and wants another: it may well be the one whose turn it is again.
    void again(Id id, Clock::time_point now);
    void remove(Id id, Clock::time_point now);
    /// To be called every few milliseconds.
    void tick(Clock::time_point now);

    /// How long the worker that was asked back longest ago has kept its turn since then; nothing where none was asked.
    [[nodiscard]] std::optional<Clock::duration> kept_since_asked(Id id, Clock::time_point now) const;
    /// How long a worker has had its turn; nothing where it has none.
    [[nodiscard]] std::optional<Clock::duration> turn_for(Id id, Clock::time_point now) const;
    [[nodiscard]] std::size_t waiting() const;
    /// Seconds of computing that a worker has had, times its threads.
    [[nodiscard]] double spent_s(Id id, Clock::time_point now) const;

  private:
    struct Worker {
        std::string person;
        bool is_job = false, wants = false;
        std::size_t threads = 0;  ///< of its turn; 0: it has none
        Clock::time_point since{}, charged{}, asked_back{};  ///< it has its turn; up to which that was counted
        bool is_asked_back = false, is_overdue = false;
        double spent = 0, share = 0;  ///< seconds; the same over its weight
    };
    struct Person {
        double spent = 0;
        std::size_t workers = 0;
    };

    void take_back(Worker& worker, Clock::time_point now);
    void charge(Worker& worker, Clock::time_point now);
    void hand_out(Clock::time_point now);
    [[nodiscard]] Worker* next(Id& id);
    [[nodiscard]] std::size_t count_waiting() const;
    [[nodiscard]] std::size_t threads_in_use() const;
    [[nodiscard]] std::size_t threads_of_a_turn() const;
    /// One that comes back after a while has not saved up for it.
    void catch_up(Worker& worker, Clock::time_point now);

    const Rules m_rules;
    const Tell m_tell;
    mutable std::mutex m_mutex;  ///< the functions above take it, those of here have it
    std::map<Id, Worker> m_workers;
    std::map<std::string, Person> m_people;
};

}  // namespace weave::simd
