#pragma once

#include <weave/design/design.hpp>

#include <QObject>

#include <cstddef>
#include <memory>
#include <optional>
#include <studio/jobs/relaxation.hpp>
#include <studio/jobs/server_place.hpp>
#include <studio/jobs/state_words.hpp>
#include <vector>

namespace weave::studio {

/// Drives the run of one design: begins it here or on a server, leads changes of the design into it as far as
/// a run takes them, and keeps what is known of it.
class SimulationDriver : public QObject {
    Q_OBJECT
  public:
    explicit SimulationDriver(QObject* parent = nullptr) : QObject(parent) {}

    /// Lays out anew and waits; a run that there was is left.
    void start(const Design& design, const sim::RunRequest& request, const std::optional<ServerWish>& server);
    void run();
    void pause();
    void step(std::uint64_t steps);
    void stop();
    void flip(const Flip& flip);
    /// Nobody looks at the run any more: it ends, and nothing of it arrives from here on.
    void leave();

    /// The design as it is now: strain, stiffness, radii, pins and fields are led into the run, and so are flips of whatever
    /// block, at each place that it has in the cloth, as soon as those are found.
    void follow(const Design& design);
    /// Whether the run shows another design all the same, so that it would have to start again.
    [[nodiscard]] bool is_behind() const { return m_is_other || !m_refused.empty(); }

    [[nodiscard]] const RunState& state() const { return m_state; }
    [[nodiscard]] const std::shared_ptr<const PlanSummary>& plan() const { return m_plan; }
    /// How much of the way to rest it has come, 0 to 1, by the logarithm of the residual; nothing while that
    /// is not known.
    [[nodiscard]] std::optional<double> share_done() const;
    [[nodiscard]] bool is_open() const { return m_run && m_run->is_open(); }
    [[nodiscard]] bool is_running() const { return m_state.phase == RunPhase::running || m_is_to_run; }

  Q_SIGNALS:
    void begun();
    void state_changed();
    void planned();
    void moved(const std::vector<weave::studio::ResidualPoint>& history);
    void laid_out(const std::shared_ptr<const weave::studio::YarnLayout>& layout);
    void frame_came(const std::shared_ptr<const weave::studio::Frame>& frame);
    void yarns_came(const std::shared_ptr<const weave::Yarns>& yarns);
    /// Of flip(): one that is done belongs into the design.
    void flip_ended(const weave::Flip& flip, bool done, const QString& reason);
    /// A flip of the design that the run does not take.
    void flip_refused(const weave::Flip& flip, const QString& reason);
    /// is_behind() may have changed, after what was found in the background or the run told.
    void behind_changed();
    void refused(const weave::Error& error);
    void troubled(const QString& words);

  private:
    void connect_run();
    [[nodiscard]] std::shared_ptr<const Yarns> named(const std::shared_ptr<const Yarns>& yarns) const;
    void enter(RunPhase phase);
    void take(const Progress& progress);
    void take_flip(const Flip& flip, bool done, const QString& reason);
    void lead_parameters(const Scene& scene);
    void look_for_flips();
    void take_flips(const Design& before, const Design& after, const std::optional<std::vector<Flip>>& flips);
    void lead(const Flip& flip);
    void forget_flips();

    std::unique_ptr<Relaxation> m_run;
    RunState m_state;
    std::shared_ptr<const PlanSummary> m_plan;
    Design m_started;  ///< what the run shows, with what was led into it
    Design m_wanted;   ///< what it is to show
    std::vector<Flip> m_asked;    ///< flips under way in the run that the design gets once they are done
    std::vector<Flip> m_led;      ///< flips under way that the design has already
    std::vector<Flip> m_refused;  ///< flips of the design that the run did not take
    double m_highest = 0;
    bool m_is_to_run = false;  ///< asked for, and not yet begun
    bool m_is_other = false;   ///< what is wanted cannot be led into it
    bool m_looks = false;      ///< for flips, in the background
    std::size_t m_runs = 0;    ///< so far; what was looked for in an earlier one is of no use
};

}  // namespace weave::studio
