#pragma once

#include <weave/sim/run.hpp>
#include <weave/wire/message.hpp>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <simd/link/link.hpp>
#include <simd/link/work_order.hpp>
#include <simd/worker/checkpoint.hpp>
#include <simd/worker/inbox.hpp>
#include <string>

namespace weave::simd {

/// The work of one worker process: a session or a job, from its order to its end. It computes only while it has a turn, and does
/// nothing that a run taken up from its last checkpoint would not do again in the same way.
class Work {
  public:
    Work(Link& link, WorkOrder order);

    /// Errors: what the design, the disk or the memory does not allow; the daemon is to be told of it.
    Status run();

  private:
    using Clock = Inbox::Clock;

    Status begin();
    Status begin_anew(const Design& design);
    Status wait_for_admission();
    Status loop();
    Status finish();

    // Between two legs.
    void keep_state();
    void save_if_due(bool now);
    void save(Json told);
    Status make_changes();
    void tell_made(const JournaledChange& change, const Status& made);
    void tell_flip_end(const JournaledChange& change);
    void rest();

    // During a leg.
    bool watch(const sim::Progress& progress);
    bool stand_still();
    [[nodiscard]] bool may_cut_legs() const;
    bool hold_turn();
    void give_turn_back();

    // What is told.
    void answer_requests();
    void answer_yarns(const Json& request);
    void tell(const Json& message);
    void tell_event(const wire::ServerMessage& event, Json more = Json::object());
    void tell_layout();
    void tell_phase(wire::Phase phase);
    void tell_progress(bool now);
    void show(bool is_last);
    void show_if_due();
    [[nodiscard]] wire::Phase standing_phase() const;

    Link& m_link;
    WorkOrder m_order;
    std::filesystem::path m_folder;
    Inbox m_inbox;
    sim::RunRequest m_request;
    std::unique_ptr<sim::Run> m_run;
    std::size_t m_leg_steps = 0, m_level = 0;
    std::uint64_t m_step = 0, m_leg_began = 0, m_frame = 0, m_layout = 0, m_changes_made = 0;
    double m_residual = 0;
    std::optional<std::uint64_t> m_lost;
    std::string m_layout_sha256;
    /// What a layout follows from: while it is the same no yarn has other points or another radius.
    struct Laid {
        std::size_t level = 0;
        double warp_radius = 0, weft_radius = 0;
        friend bool operator==(const Laid&, const Laid&) = default;
    } m_laid;
    std::optional<wire::Phase> m_phase;
    bool m_is_flipping = false, m_leg_was_long = false;
    Clock::time_point m_leg_cut{};  ///< when the leg under way ends at the latest
    Checkpoint m_kept;  ///< the state at the end of the last leg
    std::uint64_t m_saved_step = 0, m_saved_changes = 0;
    bool m_saved = false, m_has_turn = false, m_shown_last = false;
    Clock::time_point m_last_saved = Clock::now(), m_last_shown{}, m_last_told{};
};

/// Reads the order from this descriptor and does it, telling the daemon whatever comes of it. The exit status of the process.
int work_for_daemon(int link);

}  // namespace weave::simd
