#pragma once

#include <weave/sim/run.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <studio/jobs/inbox.hpp>
#include <studio/jobs/local_relaxation.hpp>
#include <studio/jobs/outbox.hpp>
#include <studio/jobs/run_meter.hpp>

namespace weave::studio {

/// The work of one run on this computer, from its plan to its end, leg by leg. Changes come between two legs;
/// a pause stands still within one, so that a run which was paused comes to the same bits as one that never
/// was.
class LocalWork {
  public:
    LocalWork(Design design, sim::RunRequest request, const LocalMeans& means, Inbox& inbox, Outbox& outbox);
    void run();

  private:
    using Clock = std::chrono::steady_clock;

    Status begin();
    Status loop();
    void finish();

    // Between two legs.
    Status make_change();
    Status make(const Order& change);
    Status flip(const Flip& flip);
    [[nodiscard]] Status foresee_room() const;
    [[nodiscard]] Status check_room_for(std::size_t times) const;
    void tell_arrival();
    void rest();

    // During a leg.
    bool watch(const sim::Progress& progress);
    bool stand_still();

    // What is asked for.
    void hear();
    void hear(Order&& order);
    void wait();
    [[nodiscard]] bool goes_on() const;

    // What is told.
    void tell_phase(RunPhase phase);
    void tell_layout();
    void show_if_due();
    void show(bool is_last);
    void tell_standing(RunPhase phase);
    [[nodiscard]] RunPhase standing_phase() const;
    void tell_yarns();

    Design m_design;
    sim::RunRequest m_request;
    LocalMeans m_means;
    Inbox& m_inbox;
    Outbox& m_outbox;
    std::unique_ptr<sim::Run> m_run;
    RunMeter m_meter;
    std::deque<Order> m_changes;
    bool m_runs = false;
    std::optional<std::uint64_t> m_pause_at;
    std::size_t m_level = 0, m_leg_steps = 0;
    std::uint64_t m_step = 0, m_leg_began = 0, m_frame = 0, m_layout = 0;
    bool m_in_leg = false, m_is_flipping = false, m_stands = false, m_leads = false;
    /// What a layout follows from.
    struct Laid {
        std::size_t level = 0;
        double warp_radius = 0, weft_radius = 0;
        friend bool operator==(const Laid&, const Laid&) = default;
    } m_laid;
    std::optional<RunPhase> m_phase;
    Clock::time_point m_last_shown{};
};

}  // namespace weave::studio
