#pragma once

#include <weave/wire/client.hpp>

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace weave::wire {

/// A client that outlives its connections: where one breaks, it connects again, after pauses that grow, attaches to
/// its session again, and repeats what was not answered. Every event of the session, and every end of a job, comes once
/// and in order; of frames the newest. Blocking, for one thread. It gives up, for good, with what does not pass (errors of
/// another kind than system, as Client's), and with the last error once it has been without a connection that is of use for
/// the time that its caller named.
class Follower {
  public:
    /// Connects as `name`. `patience`: how long it goes on trying once a connection is lost. The first is tried once.
    static Result<Follower> connect(ServerPlace place, std::string name, std::chrono::milliseconds patience);

    [[nodiscard]] const ServerPlace& place() const { return m_place; }

    /// Makes a session and follows it from its first event. Serves one session at a time.
    Result<Accepted> create(std::string document, const Simulation& simulation, std::chrono::milliseconds patience);
    /// Takes up an earlier session of the same person behind this event and this frame.
    Status attach(std::uint64_t session, std::uint64_t seq, std::uint64_t frame, std::chrono::milliseconds patience);
    /// Sends a message that has an id, but neither Create nor Attach, until an answer comes; several times if it must
    /// be, which does it once, as the id is the same. Errors besides: system where no answer comes in time.
    Result<ServerMessage> ask(const ClientMessage& message, std::chrono::milliseconds patience);

    /// The next message or frame that answers nothing; nothing if none comes in time, though a try to connect may
    /// take longer. Events that it gave before count as dealt with, and are acknowledged.
    Result<std::optional<Received>> receive(std::chrono::milliseconds patience);
    /// Tells the server that the events given so far are dealt with, for a caller that asks for no more.
    Status acknowledge();
    /// The end of this job has been dealt with, its files are here: the server may forget it. Waits until it knows.
    Status acknowledge_job(std::uint64_t job, std::chrono::milliseconds patience);

    /// A file of the server's, as wire::download(), asked for again where that fails with what may pass.
    Result<std::string> download(const std::string& target, std::uint64_t most);

    /// What keeps it from its server; nothing while it is connected.
    [[nodiscard]] const std::optional<Error>& trouble() const { return m_trouble; }
    /// Told when trouble comes and when it is over (nullptr), by whichever call meets it, while it goes on trying.
    void on_trouble(std::function<void(const Error*)> told) { m_on_trouble = std::move(told); }
    /// Says goodbye.
    void close();

  private:
    using Clock = std::chrono::steady_clock;

    /// The session that is followed, and how far.
    struct Followed {
        std::uint64_t session = 0;
        std::uint64_t seq = 0, frame = 0;           ///< came last
        std::uint64_t given = 0, acknowledged = 0;  ///< events that the caller has; those of them that the server knows of
        std::optional<double> most_per_second = {};  ///< frames that were asked for
        bool whole = false;  ///< nobody can have acknowledged events that are still to come
        bool ended = false, settled = false;  ///< its last event came; and was acknowledged
    };

    Follower(ServerPlace place, std::string name, std::chrono::milliseconds patience);
    Status connect_once();
    Status take_up();
    Status make_room();
    Status reconnect(Clock::time_point end);
    Status lost(Error error);
    void note_trouble(std::optional<Error> trouble);
    Status pump(Clock::time_point end, const std::string& id, std::optional<ServerMessage>& answer);
    Result<ServerMessage> ask(const ClientMessage& message, std::chrono::milliseconds patience, int& times);
    Status tell(const ClientMessage& message);
    void note_frames(const ClientMessage& message, const ServerMessage& answer);
    [[nodiscard]] Error no_answer() const;

    Status take(Received received);
    Status take_event(std::uint64_t session, std::uint64_t seq, ServerMessage message);
    Status take_frame(Frame frame);
    Status take_job_end(JobEnded ended);
    Status take_progress(JobProgress progress);
    Status queue(Received received);
    [[nodiscard]] Error breach(const std::string& what) const;

    ServerPlace m_place;
    std::string m_name;
    std::chrono::milliseconds m_patience, m_pause;
    std::optional<Client> m_client;
    std::uint64_t m_connections = 0;  ///< that there were so far
    std::optional<Followed> m_followed;
    std::deque<Received> m_waiting;  ///< for the caller
    std::set<std::uint64_t> m_told_jobs, m_settled_jobs;  ///< whose end the caller was told; and has dealt with
    std::optional<Error> m_trouble, m_over;
    std::function<void(const Error*)> m_on_trouble;
    std::optional<Clock::time_point> m_since;  ///< when the last connection that was of use broke
    Clock::time_point m_connected, m_next_try;
    bool m_heard = false;  ///< on this connection, something beside what every connection begins with
};

}  // namespace weave::wire
