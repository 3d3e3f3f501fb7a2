#pragma once

#include <weave/net/message.hpp>
#include <weave/wire/message.hpp>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <simd/daemon/client.hpp>
#include <simd/daemon/crew.hpp>
#include <simd/daemon/step_rate.hpp>
#include <simd/daemon/task.hpp>
#include <simd/store/store.hpp>
#include <string>
#include <utility>
#include <vector>

namespace weave::simd {

/// A live simulation: what is known of it here, its worker, and who looks on. All under the daemon's lock.
class Session final : public Task {
  public:
    using Clock = std::chrono::steady_clock;
    using ClientPtr = std::shared_ptr<Client>;

    struct Surroundings {
        Store& store;
        Crew& crew;
        std::filesystem::path folder;        ///< of this session
        std::function<void()> wants_writing;  ///< is told that there is something for the disk
        std::function<std::optional<double>()> expected_wait_s;  ///< until something gives its room back
    };

    /// What the store is to have of a session.
    struct Writing {
        std::uint64_t number = 0;
        std::vector<Event> events;
        std::vector<Dated> dated;
        std::optional<SessionState> state;
        std::optional<std::uint64_t> acknowledged;  ///< up to which event
    };

    /// One that the store does not know yet: it becomes a session once its worker has planned it and there is room.
    Session(Surroundings around, const wire::Create& create, const ClientPtr& client);
    /// One that the store had.
    Session(Surroundings around, const KeptSession& kept, const SessionTask& task, std::vector<JournaledChange> changes);
    ~Session() override;

    [[nodiscard]] std::uint64_t number() const { return m_number; }
    [[nodiscard]] const std::string& person() const { return m_person; }
    [[nodiscard]] const std::string& request() const { return m_request; }
    [[nodiscard]] bool is_accepted() const { return m_number != 0; }
    /// Nothing is left of it to be told or done.
    [[nodiscard]] bool is_over() const { return m_is_over; }
    [[nodiscard]] bool has_ended() const { return m_has_ended; }
    /// Since nobody has been attached; nothing while somebody is.
    [[nodiscard]] std::optional<Clock::duration> left_alone() const {
        return m_viewers.empty() ? std::optional(Clock::now() - m_seen) : std::nullopt;
    }
    [[nodiscard]] wire::SessionSummary summary(std::chrono::seconds expire) const;
    [[nodiscard]] Json status(bool with_names) const;

    // ---- What clients ask; each answers ----

    /// Asked again: is told, but not attached.
    void wait_for_creation(const ClientPtr& client) { m_creators.push_back(client); }
    /// Is one of those that asked for this session, which is still being planned.
    [[nodiscard]] bool is_awaited_by(const ClientPtr& client) const { return std::ranges::find(m_creators, client) != m_creators.end(); }
    void attach(const ClientPtr& client, const wire::Attach& attach);
    void leave(const ClientPtr& client);
    void go_on(const ClientPtr& client, const std::string& request, std::optional<std::uint64_t> steps);
    void pause(const ClientPtr& client, const std::string& request);
    void change(const ClientPtr& client, const wire::MakeChange& change);
    void read_state(const ClientPtr& client, const std::string& request) const;
    void checkpoint(const ClientPtr& client, const std::string& request);
    void close(const ClientPtr& client, const std::string& request);
    /// Is kept with whatever is written next: at worst an event is told once more.
    void acknowledge(std::uint64_t seq);
    void want_frames(const ClientPtr& client, const wire::WantFrames& want);
    /// Has the yarns written as they lie; `done` is told with their file, or why not.
    void write_yarns(std::function<void(Result<std::filesystem::path>)> done);

    // ---- What the daemon does with it ----

    /// Of a session that the store had, first: where its events stand.
    Status remember_events();
    void take_up();
    /// The worker writes its checkpoint and ends.
    void put_away();
    [[nodiscard]] bool is_put_away() const { return !m_worker; }
    void tick(Clock::time_point now, std::chrono::seconds expire);
    /// What is to be written, and that it was: events are told once the disk has them. Writing takes its time, so it is done
    /// without the lock.
    [[nodiscard]] std::optional<Writing> to_write() const;
    void written(const Writing& writing);
    [[nodiscard]] bool is_written() const { return m_unsaved.empty(); }

    // ---- Task ----

    WorkOrder order() override;
    void planned(const Json& plan) override;
    void said(const std::string& what, const Json& message) override;
    void shown(std::string frame) override;
    void ended(const WorkerEnd& end) override;

  private:
    struct Unsaved {
        Event event;
        std::optional<Dated> dated;
    };
    /// Somebody who is attached, and how far he or she has been told.
    struct Viewer {
        ClientPtr client;
        std::uint64_t sent = 0;   ///< the last event
        std::uint64_t frame = 0;  ///< the last that it had
        bool is_shown = false;    ///< has caught up, and is shown frames
    };

    [[nodiscard]] std::optional<double> left_s(std::chrono::seconds expire) const;
    void refuse_creation(Error error, std::optional<double> wait_s);
    Status become_accepted();
    [[nodiscard]] Error gone() const;
    void emit(wire::ServerMessage event, EventKind kind, std::optional<Dated> dated = {});
    void bring_up(Viewer& viewer);
    void show_newest();
    void say_goodbye();
    void end(wire::Why why, std::uint64_t step, std::optional<Error> error, Json report);
    [[nodiscard]] SessionState kept_state() const;
    Status save_state();
    void heard_event(const Json& message);
    void heard_checkpoint(const Json& message);
    void heard_yarns(const Json& message);
    void fail_waiting(const Error& error);
    void tell_rates();
    void post(const Json& message);
    void answer(const ClientPtr& client, const std::string& request);
    void refuse(const ClientPtr& client, const std::string& request, Error error) const;
    [[nodiscard]] std::optional<Error> why_no_change(const wire::Change& change) const;
    bool unfolds_for(const wire::Change& change) const;

    Surroundings m_around;
    std::string m_person, m_request, m_title, m_document;
    wire::Simulation m_simulation;
    std::uint64_t m_number = 0;
    std::optional<Crew::Id> m_worker;
    std::vector<JournaledChange> m_changes;
    ClientPtr m_creator;  ///< whose connection is attached once the session is made
    std::vector<ClientPtr> m_creators;  ///< all that wait for it
    std::vector<Viewer> m_viewers;

    std::uint64_t m_seq = 0, m_saved_seq = 0, m_acknowledged = 0, m_saved_acknowledged = 0, m_frame = 0, m_frames_promised = 0, m_layout = 0, m_step = 0;
    std::string m_layout_sha256;
    wire::Phase m_phase = wire::Phase::paused;
    bool m_runs = false;
    std::optional<std::uint64_t> m_pause_at;
    std::uint64_t m_steps_id = 0;  ///< of the steps that are being made one by one; 0: none are
    std::uint64_t m_checkpoint_step = 0;
    double m_residual = 0;
    StepRate m_rate;
    std::optional<std::uint64_t> m_lost;
    std::size_t m_points = 0, m_repeats = 1;
    std::uint64_t m_bytes = 0, m_unfolded_bytes = 0;  ///< that it is expected to take now, and once all repeats are simulated
    net::Bytes m_newest;
    std::uint64_t m_newest_number = 0;
    bool m_newest_is_last = false, m_state_changed = false;
    Clock::time_point m_seen = Clock::now();  ///< when somebody was attached last

    bool m_takes_up = false, m_is_recovering = false, m_is_closing = false, m_is_put_away = false, m_has_ended = false, m_is_over = false;
    Clock::time_point m_ended_at{};
    std::size_t m_faults = 0;     ///< in a row, none of which got further
    std::uint64_t m_furthest = 0;  ///< step that a worker had reached when it ended
    std::vector<Unsaved> m_unsaved;  ///< events that the disk did not take yet
    std::uint64_t m_last_id = 0;
    std::map<std::uint64_t, std::pair<ClientPtr, std::string>> m_checkpoint_requests;
    std::map<std::uint64_t, std::function<void(Result<std::filesystem::path>)>> m_yarns_requests;
};

}  // namespace weave::simd
