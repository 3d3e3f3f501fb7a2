#pragma once

#include <weave/sim/pace.hpp>
#include <weave/wire/message.hpp>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <simd/daemon/crew.hpp>
#include <simd/daemon/slurm_crew.hpp>
#include <simd/daemon/step_rate.hpp>
#include <simd/daemon/task.hpp>
#include <simd/store/store.hpp>
#include <string>

namespace weave::simd {

/// A batch run, from its place in the queue to its acknowledged end. All under the daemon's lock.
class Job final : public Task {
  public:
    using Clock = std::chrono::steady_clock;

    struct Surroundings {
        Store& store;
        Crew& crew;
        SlurmCrew* slurm;              ///< null: the crew of this machine does it
        std::filesystem::path folder;  ///< of this job
        /// The signed evidence document for a report and the hash of its yarns; nothing where this machine signs none.
        std::function<std::optional<std::string>(const Json& report)> sign;
        /// Is told once it has ended.
        std::function<void(const Job&)> has_ended;
    };

    Job(Surroundings around, KeptJob kept);
    ~Job() override;

    [[nodiscard]] std::uint64_t number() const { return m_kept.number; }
    [[nodiscard]] const std::string& person() const { return m_kept.person; }
    [[nodiscard]] wire::JobPhase phase() const { return m_phase; }
    [[nodiscard]] bool is_over() const { return m_phase >= wire::JobPhase::done; }
    /// Has a worker, or waits for one of the crew, or is Slurm's business.
    [[nodiscard]] bool is_at_work() const { return m_worker || m_is_in_slurm; }
    [[nodiscard]] bool waits() const { return !is_over() && !is_at_work() && !m_is_put_away; }
    /// Memory that it will take, where that is known already.
    [[nodiscard]] std::uint64_t expected() const { return m_bytes; }
    /// Since it came, or since the daemon was started.
    [[nodiscard]] Clock::duration waited() const { return Clock::now() - m_came; }
    [[nodiscard]] wire::JobState state() const;
    /// Estimated until its end, seconds.
    [[nodiscard]] std::optional<double> left_s() const;
    [[nodiscard]] wire::JobEnded ending() const;
    [[nodiscard]] std::optional<std::filesystem::path> yarns() const;
    [[nodiscard]] const std::optional<std::string>& evidence() const { return m_end.evidence; }
    [[nodiscard]] Json status(bool with_names) const;

    /// Goes on where Slurm has it since an earlier life of the daemon.
    void take_up();
    /// Has it put to work; nothing where the store cannot be read just now.
    void begin();
    void cancel();
    void put_away();
    [[nodiscard]] bool is_put_away() const { return !m_worker; }
    /// Tries again to write an end that the disk did not take.
    void tick();

    WorkOrder order() override;
    void planned(const Json& plan) override;
    void said(const std::string& what, const Json& message) override;
    void shown(std::string) override {}
    void ended(const WorkerEnd& end) override;

  private:
    void begun();
    void end(wire::JobPhase phase, std::optional<Error> error, Json report, std::string yarns);
    void save_end();

    Surroundings m_around;
    KeptJob m_kept;
    std::optional<JobTask> m_task;  ///< from the store, until its worker has it
    bool m_has_flips = false;
    JobEnd m_end;  ///< once it is over
    wire::JobPhase m_phase = wire::JobPhase::waiting;
    std::optional<Crew::Id> m_worker;
    std::size_t m_points = 0, m_faults = 0;
    std::uint64_t m_bytes = 0;  ///< that it is expected to take; 0: not known yet, or Slurm's business
    std::uint64_t m_step = 0, m_furthest = 0;
    double m_residual = 0;
    std::optional<std::uint64_t> m_lost;  ///< crossings out of order, once they were looked up
    StepRate m_rate;
    std::optional<sim::Pace> m_pace;
    Clock::time_point m_began{}, m_came = Clock::now();
    bool m_is_in_slurm = false;
    bool m_is_cancelled = false, m_is_ended_again = false, m_is_put_away = false, m_is_done = false, m_is_saved = false;
    Json m_report = Json::object();
    std::optional<Error> m_error;
};

}  // namespace weave::simd
