#pragma once

#include <weave/sim/pace.hpp>

#include <chrono>
#include <cstdint>
#include <optional>
#include <studio/jobs/happenings.hpp>

namespace weave::studio {

/// Keeps what a run's progress is told from: the residuals since it was told last, and the time that it took
/// without its pauses.
class RunMeter {
  public:
    /// From here on towards this residual.
    void aim_at(double goal);
    void pass_step(std::uint64_t step, double residual);
    /// What a leg came to, which a step need not have told.
    void end_leg(std::uint64_t step, double residual);
    void see_lost(std::optional<std::uint64_t> lost) { m_now.lost_crossings = lost; }
    void see_flip(bool is_flipping) { m_now.is_flipping = is_flipping; }
    void see_coarse(bool is_coarse) { m_now.is_coarse = is_coarse; }

    void go_on();
    void stand();
    [[nodiscard]] std::uint64_t step() const { return m_now.step; }
    [[nodiscard]] double residual() const { return m_now.residual; }
    /// How far it has come; the history is told once.
    [[nodiscard]] Progress take();

  private:
    using Clock = std::chrono::steady_clock;
    [[nodiscard]] double seconds() const;

    Progress m_now;
    std::optional<sim::Pace> m_pace;
    Clock::duration m_spent{};
    std::optional<Clock::time_point> m_since;
};

}  // namespace weave::studio
