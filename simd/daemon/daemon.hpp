#pragma once

#include <weave/core/json.hpp>
#include <weave/net/health.hpp>
#include <weave/net/metrics.hpp>
#include <weave/net/throttle.hpp>
#include <weave/wire/message.hpp>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <simd/daemon/client.hpp>
#include <simd/daemon/crew.hpp>
#include <simd/daemon/job.hpp>
#include <simd/daemon/session.hpp>
#include <simd/store/store.hpp>
#include <string>
#include <thread>
#include <vector>

namespace weave::simd {

struct DaemonSettings {
    std::filesystem::path folder;  ///< where sessions and jobs have their files
    Crew::Rules crew;
    std::optional<SlurmCrew::Rules> slurm;  ///< jobs go to Slurm; none: this machine does them
    std::size_t most_sessions = 64, sessions_per_person = 16;
    std::size_t jobs_at_once = 2, jobs_per_person = 1000;
    std::chrono::seconds expire{24 * 3600};  ///< a session to which nobody is attached for so long is ended
    std::function<std::optional<std::string>(const Json& report)> sign;  ///< evidence of a job; null: none
    std::shared_ptr<net::Metrics> metrics;
};

/// All sessions and jobs of this machine, for whoever is connected. Safe from any thread.
class Daemon {
  public:
    using Clock = std::chrono::steady_clock;
    using ClientPtr = std::shared_ptr<Client>;

    /// Takes up what the store has, and works from now on.
    static Result<std::unique_ptr<Daemon>> start(std::unique_ptr<Store> store, const DaemonSettings& settings);
    /// Ends all workers; those that stop() had put away can be taken up where they are.
    ~Daemon();
    Daemon(const Daemon&) = delete;
    Daemon& operator=(const Daemon&) = delete;

    /// A connection has come; one that says no hello for 10 s is closed.
    void enter(const ClientPtr& client);
    /// Somebody has said hello, and is told of the jobs that ended meanwhile.
    void greet(const ClientPtr& client);
    /// Does what a message asks for, and answers it.
    void obey(const ClientPtr& client, const wire::ClientMessage& message);
    void leave(const ClientPtr& client);

    /// A file with the yarns of a session as they lie; it is the caller's to remove. Waits for the worker.
    Result<std::filesystem::path> session_yarns(const std::string& person, std::uint64_t session);
    Result<std::filesystem::path> job_yarns(const std::string& person, std::uint64_t job);
    Result<std::string> job_evidence(const std::string& person, std::uint64_t job);

    /// Sessions, jobs, memory and pace; of whom and of what with `with_names`.
    [[nodiscard]] Json status(bool with_names);
    [[nodiscard]] std::vector<net::HealthCheck> health();

    /// Has everything put away, and waits for that up to `patience`.
    void stop(std::chrono::milliseconds patience);

  private:
    Daemon(std::unique_ptr<Store> store, const DaemonSettings& settings);
    Status take_up();
    void work();
    void write_events();
    void tell_ended_jobs(const ClientPtr& client);
    void tick(Clock::time_point now);
    void tell_jobs();
    void forget_what_is_over();
    void send_away(Clock::time_point now);
    void begin_jobs();
    void hand_over_jobs();
    void count();
    void job_ended(const Job& job);
    /// Until a job ends or a session that was left alone does, as far as that can be foreseen.
    [[nodiscard]] std::optional<double> expected_wait_s() const;
    [[nodiscard]] Session::Surroundings around_session();
    [[nodiscard]] Job::Surroundings around_job();
    [[nodiscard]] std::vector<Job*> queue();
    /// What can be said of the queue.
    struct Outlook {
        std::map<const Job*, std::size_t> places;  ///< of those that wait, from 1
        std::optional<double> first_s;             ///< expected until the next one begins
        double each_s = 0;                         ///< the same from one to the next
        [[nodiscard]] std::optional<double> wait_s(std::size_t place) const;
    };
    [[nodiscard]] Outlook outlook();
    [[nodiscard]] static wire::JobState told_state(const Job& job, const Outlook& outlook);
    Session* session_of(const std::string& person, std::uint64_t number);
    Job* job_of(const std::string& person, std::uint64_t number);
    [[nodiscard]] bool serves_a_session(const ClientPtr& client) const;
    bool answered_before(const ClientPtr& client, const std::string& request, bool needs_disk);

    void create(const ClientPtr& client, const wire::Create& create);
    void submit(const ClientPtr& client, const wire::Submit& submit, const std::string& title);
    void attach(const ClientPtr& client, const wire::Attach& attach);
    void list_sessions(const ClientPtr& client, const std::string& request);
    void list_jobs(const ClientPtr& client, const std::string& request);
    void cancel(const ClientPtr& client, const wire::Cancel& cancel);
    void acknowledge_job(const ClientPtr& client, std::uint64_t job);
    template <class Message>
    void obey_one(const ClientPtr& client, const Message& message);
    template <class Message, class Do>
    void with_session(const ClientPtr& client, const Message& message, Do what);

    DaemonSettings m_settings;
    std::mutex m_lock;
    std::unique_ptr<Store> m_store;
    Crew m_crew;
    std::unique_ptr<SlurmCrew> m_slurm;  ///< null: none
    std::vector<std::unique_ptr<Session>> m_sessions;
    std::vector<std::unique_ptr<Job>> m_jobs;
    std::set<ClientPtr> m_clients;
    std::vector<double> m_job_seconds;  ///< that recent jobs took
    Clock::time_point m_jobs_told{}, m_began = Clock::now();
    bool m_is_stopping = false, m_ends = false;
    net::Throttle m_requests{{60, 30, 10000}};  ///< that change something, by person: each costs the disk a flush
    std::condition_variable m_wants_writing;
    bool m_has_to_write = false;
    std::string m_write_trouble;  ///< what kept the writer from writing, last
    std::thread m_thread, m_writer;
};

}  // namespace weave::simd
