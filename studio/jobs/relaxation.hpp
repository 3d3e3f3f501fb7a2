#pragma once

#include <weave/core/result.hpp>
#include <weave/design/design.hpp>
#include <weave/sim/run.hpp>

#include <QObject>
#include <QString>

#include <cstdint>
#include <functional>
#include <memory>
#include <studio/jobs/happenings.hpp>
#include <studio/jobs/inbox.hpp>
#include <studio/jobs/outbox.hpp>
#include <vector>

namespace weave::studio {

/// Yarns that relax elsewhere, as the window sees them: all calls return at once, and signals come in the
/// window's thread. What is computed where, say LocalRelaxation and RemoteRelaxation. It may be destroyed at
/// any time; its thread ends by itself.
class Relaxation : public QObject {
    Q_OBJECT
  public:
    explicit Relaxation(QObject* parent = nullptr) : QObject(parent) {}
    ~Relaxation() override;

    /// Lays the yarns out and shows them, then waits for run() or step(). A run that there was is left.
    void start(const Design& design, const sim::RunRequest& request);
    /// On until at rest, also after changes.
    void run();
    /// Takes effect within a step.
    void pause();
    /// So many steps, then paused.
    void step(std::uint64_t steps);
    /// Ends it with the yarns as they lie; at once where they are not laid out yet.
    void stop();

    /// Leads strain, stiffness and radii to these values, as a scene has them; what is absent stays.
    void set_parameters(const SystemScene& warp, const SystemScene& weft);
    /// Leads a crossing to its other side; flip_ended() tells how that went.
    void flip(const Flip& flip);
    /// The yarns that are held from now on, where they lie.
    void hold(const std::vector<Pin>& pins);
    /// The fields that push from now on.
    void push(const std::vector<ForceField>& fields);

    [[nodiscard]] RunPhase phase() const { return m_phase; }
    /// Whether there is a run that takes orders.
    [[nodiscard]] bool is_open() const { return m_line != nullptr; }

  Q_SIGNALS:
    void phase_changed(weave::studio::RunPhase phase);
    /// What is modelled and why, before the first step.
    void planned(const std::shared_ptr<const weave::studio::PlanSummary>& plan);
    /// What the yarns of the frames from here on are.
    void laid_out(const std::shared_ptr<const weave::studio::YarnLayout>& layout);
    /// At most 30 a second, and the newest alone.
    void frame_came(const std::shared_ptr<const weave::studio::Frame>& frame);
    void progressed(const weave::studio::Progress& progress);
    /// The yarns with their report, each time they come to rest, are paused or stopped after a step.
    void ended(const std::shared_ptr<const weave::Yarns>& yarns);
    /// What a weaver wants to know of them, once they get no further.
    void inspected(const std::shared_ptr<const weave::Yarns>& yarns,
                   const std::shared_ptr<const weave::Inspection>& inspection);
    void flip_ended(const weave::Flip& flip, bool done, const QString& reason);
    /// Parameters have come to what was asked for. A server does not tell before the cloth is at rest.
    void parameters_arrived();
    /// Something that was asked for is not done; the run is as it was.
    void refused(const weave::Error& error);
    /// What keeps it from its server, in words; empty once that is over. It goes on trying.
    void troubled(const QString& words);
    /// The run is over.
    void failed(const weave::Error& error);

  protected:
    using Work = std::function<void(Inbox&, Outbox&)>;
    /// The work of one run, for a thread of its own; it must not touch this object.
    [[nodiscard]] virtual Work work_of(const Design& design, const sim::RunRequest& request) const = 0;

  private:
    struct Line {
        Inbox inbox;
        Outbox outbox;
    };
    void order(Order order);
    void leave();
    void deliver();
    void enter(RunPhase phase);
    void tell(const Happening& happening);

    std::shared_ptr<Line> m_line;
    RunPhase m_phase = RunPhase::idle;
};

}  // namespace weave::studio
