#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <simd/daemon/room.hpp>
#include <simd/daemon/task.hpp>
#include <simd/daemon/turns.hpp>
#include <simd/link/worker_process.hpp>
#include <string>
#include <vector>

namespace weave::simd {

/// The worker processes: started a few at a time, admitted where there is memory, given turns, watched, and taken away. Its owner
/// has the lock for every call but bury().
class Crew {
  public:
    using Clock = std::chrono::steady_clock;
    using Id = std::uint64_t;

    struct Rules {
        std::filesystem::path program;      ///< this one
        Turns::Rules turns;
        std::string backend = "auto";       ///< what they compute on, by sim::parse_backend
        std::uint64_t memory_bytes = 0;     ///< for all workers together
        std::size_t planning_at_once = 2;
        /// One that plans for longer no longer keeps others waiting; its person's next ones wait for it.
        std::chrono::seconds planning_patience{10};
        /// A worker is ended that plans for so long, keeps its turn for so long after it was asked back, or for so long says nothing
        /// where there is something to say: it computes, or was asked for its end.
        std::chrono::seconds stall{300};
    };

    Crew(std::mutex& lock, const Rules& rules);
    /// Ends all workers at once.
    ~Crew();

    /// Has a worker started for this task as soon as its turn to plan comes. The task must outlive it, or dismiss it.
    Id hire(Task& task, const std::string& person, bool is_job);
    /// Grants what is planned its memory; false where there is too little. `also` is told with it: number and folder.
    bool admit(Id id, std::uint64_t bytes, Json also);
    void post(Id id, const Json& message);
    /// Asks a worker to put away what it has and end: with a report of where the cloth lies, or without.
    void ask_to_end(Id id, bool with_report);
    /// Ends a worker at once; its task is told.
    void kill(Id id);
    /// The same, but nobody is told.
    void dismiss(Id id);
    /// To be called every few milliseconds, from one thread that lasts as long as the crew: workers die with it.
    void tick(Clock::time_point now);
    /// Clears away what has ended. Without the lock.
    void bury();

    [[nodiscard]] Room& room() { return m_room; }
    [[nodiscard]] const Turns& turns() const { return m_turns; }
    [[nodiscard]] std::size_t size() const { return m_members.size(); }
    [[nodiscard]] std::optional<pid_t> process(Id id) const;
    [[nodiscard]] std::uint64_t memory_bytes(Id id) const;

  private:
    struct Member {
        Task* task = nullptr;  ///< null: dismissed
        std::string person;
        bool is_job = false, is_admitted = false;
        std::optional<Clock::time_point> asked_to_end;
        std::unique_ptr<WorkerProcess> process;
        Clock::time_point started{};
        WorkerEnd end;
    };

    void start(Id id, Member& member);
    void heard(Id id, LinkMessage message);
    void heard_words(Id id, const Json& message);
    void obey(Member& member, const std::string& what, const Json& message);
    bool heard_of_turn(Id id, const std::string& what, const Json& message);
    void tell_of_turn(Id id, const Json& message);
    [[nodiscard]] Member* served(Id id);
    void lost(Id id, std::string how);
    void start_some(Clock::time_point now);
    void end_stuck(Clock::time_point now);
    [[nodiscard]] std::optional<Error> why_stuck(Id id, const Member& member, Clock::time_point now) const;
    [[nodiscard]] std::optional<Clock::duration> planning_for(const Member& member, Clock::time_point now) const;

    std::mutex& m_lock;
    Rules m_rules;
    Room m_room;
    std::mutex m_links_lock;
    std::map<Id, Link*> m_links;  ///< over which turns are told, under this lock of their own
    Turns m_turns;
    Id m_last = 0;
    std::map<Id, Member> m_members;
    std::deque<Id> m_to_start;
    std::vector<std::unique_ptr<WorkerProcess>> m_dead;
};

}  // namespace weave::simd
