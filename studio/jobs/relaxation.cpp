#include <studio/jobs/relaxation.hpp>

#include <QPointer>

#include <exception>
#include <new>
#include <studio/jobs/leaving_threads.hpp>
#include <utility>

namespace weave::studio {

namespace {

template <class... Handlers>
struct Overload : Handlers... {
    using Handlers::operator()...;
};

bool is_over(RunPhase phase) {
    return phase == RunPhase::failed || phase == RunPhase::stopped;
}

}  // namespace

Relaxation::~Relaxation() {
    leave();
}

void Relaxation::leave() {
    if (!m_line) return;
    m_line->outbox.close();
    m_line->inbox.finish(Finish::leave);
    m_line.reset();
}

void Relaxation::start(const Design& design, const sim::RunRequest& request) {
    leave();
    m_line = std::make_shared<Line>();
    m_line->outbox.open(this, [this] { deliver(); });
    run_apart([line = m_line, work = work_of(design, request)] {
        try {
            work(line->inbox, line->outbox);
        } catch (const std::bad_alloc&) {
            line->outbox.tell(
                system_fault("the memory of this computer is not enough for it; simulate a part of the cloth"));
        } catch (const std::exception& fault) {
            line->outbox.tell(system_fault(fault.what()));
        }
        return_freed_memory();
    });
    enter(RunPhase::planning);
}

void Relaxation::order(Order order) {
    if (m_line) m_line->inbox.order(std::move(order));
}

void Relaxation::run() {
    order(RunOrder{});
}

void Relaxation::pause() {
    order(PauseOrder{});
}

void Relaxation::step(std::uint64_t steps) {
    if (steps > 0) order(StepOrder{steps});
}

/// Laying out cannot be broken off, and there is nothing to see of it: its thread ends by itself.
void Relaxation::stop() {
    if (m_phase == RunPhase::planning) return enter(RunPhase::stopped);
    if (m_line) m_line->inbox.finish(Finish::report);
}

void Relaxation::set_parameters(const SystemScene& warp, const SystemScene& weft) {
    if (warp == SystemScene{} && weft == SystemScene{}) return;
    order(wire::Parameters{warp, weft});
}

void Relaxation::flip(const Flip& flip) {
    order(flip);
}

void Relaxation::hold(const std::vector<Pin>& pins) {
    order(wire::Pins{pins});
}

void Relaxation::push(const std::vector<ForceField>& fields) {
    order(wire::Fields{fields});
}

void Relaxation::enter(RunPhase phase) {
    if (is_over(phase)) leave();
    if (m_phase == phase) return;
    m_phase = phase;
    Q_EMIT phase_changed(phase);
}

/// Who hears of it may begin another run, or destroy this object.
void Relaxation::deliver() {
    const std::shared_ptr<Line> line = m_line;
    if (!line) return;
    const QPointer<Relaxation> alive(this);
    for (const Happening& happening : line->outbox.take()) {
        if (!alive || m_line != line) return;
        tell(happening);
    }
}

void Relaxation::tell(const Happening& happening) {
    const Overload tell_of{
        [this](RunPhase phase) { enter(phase); },
        [this](const std::shared_ptr<const PlanSummary>& plan) { Q_EMIT planned(plan); },
        [this](const std::shared_ptr<const YarnLayout>& layout) { Q_EMIT laid_out(layout); },
        [this](const std::shared_ptr<const Frame>& frame) { Q_EMIT frame_came(frame); },
        [this](const Progress& progress) { Q_EMIT progressed(progress); },
        [this](const std::shared_ptr<const Yarns>& yarns) { Q_EMIT ended(yarns); },
        [this](const Inspected& one) { Q_EMIT inspected(one.yarns, one.inspection); },
        [this](const FlipEnd& end) {
            Q_EMIT flip_ended(end.flip, end.done, QString::fromStdString(end.reason));
        },
        [this](const ParametersArrived&) { Q_EMIT parameters_arrived(); },
        [this](const ChangeRefused& change) { Q_EMIT refused(change.error); },
        [this](const Trouble& trouble) { Q_EMIT troubled(QString::fromStdString(trouble.words)); },
        [this](const Error& error) {
            const QPointer<Relaxation> alive(this);
            enter(RunPhase::failed);
            if (alive) Q_EMIT failed(error);
        },
    };
    std::visit(tell_of, happening);
}

}  // namespace weave::studio
