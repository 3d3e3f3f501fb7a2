#include <studio/jobs/local_work.hpp>

#include <weave/design/evaluate.hpp>
#include <weave/sim/memory_room.hpp>
#include <weave/wire/shown.hpp>

#include <algorithm>
#include <studio/jobs/plan_summary.hpp>
#include <utility>

namespace weave::studio {

namespace {

constexpr std::chrono::milliseconds between_frames{34};  // at most 30 a second

}  // namespace

LocalWork::LocalWork(Design design, sim::RunRequest request, const LocalMeans& means, Inbox& inbox,
                     Outbox& outbox)
    : m_design(std::move(design)),
      m_request(std::move(request)),
      m_means(means),
      m_inbox(inbox),
      m_outbox(outbox) {}

void LocalWork::run() {
    Status done = begin();
    if (done) done = loop();
    if (!done) return m_outbox.tell(std::move(done).error());
    finish();
}

Status LocalWork::begin() {
    if (const auto room = sim::room_here(); room && !m_means.memory_bytes) m_means.memory_bytes = room->bytes;
    WEAVE_CHECK_OK(foresee_room());
    auto run = sim::Run::begin(m_design, m_request, m_means.threads);
    if (!run) return std::move(run).error();
    m_run = std::move(*run);
    m_outbox.tell(std::make_shared<const PlanSummary>(summary_of(m_run->now().plan(), m_design.title)));
    return check_room_for(1);
}

/// Whether the memory is expected to do for so many times the piece that is simulated.
Status LocalWork::check_room_for(std::size_t times) const {
    if (!m_means.memory_bytes) return {};
    sim::MemoryNeed need = sim::need_of(m_run->now().plan());
    need.points *= times;
    if (times > 1) need.copied_bytes = 0;  // then nothing is copied back
    return sim::check_room(need, {*m_means.memory_bytes, {}});
}

/// Laying out a cloth that has no room takes half a minute and gigabytes.
Status LocalWork::foresee_room() const {
    if (!m_means.memory_bytes) return {};
    WEAVE_TRY(const Evaluation evaluation, evaluate(m_design));
    const auto need = sim::foreseen_need(m_design, *evaluation.block, m_request.plan);
    return need ? sim::check_room(*need, {*m_means.memory_bytes, {}}) : Status();
}

Status LocalWork::loop() {
    hear();
    while (m_inbox.finish() == Finish::no) {
        if (m_level != m_run->level()) {
            m_level = m_run->level();
            m_leg_steps = sim::leg_steps(m_run->now().plan(), m_request.goal.solver);
        }
        m_step = m_run->steps();
        if (m_run->settle_between()) continue;
        m_meter.aim_at(m_run->now().goal());
        m_meter.see_coarse(m_run->is_coarse());
        tell_layout();
        tell_arrival();
        hear();
        if (!m_changes.empty()) {
            WEAVE_CHECK_OK(make_change());
            continue;
        }
        if (m_run->is_over() || !goes_on()) {
            rest();
            continue;
        }
        tell_phase(RunPhase::running);
        m_leg_began = m_step;
        m_stands = false;
        m_in_leg = true;
        WEAVE_CHECK_OK(
            m_run->advance(m_leg_steps, [this](const sim::Progress& progress) { return watch(progress); }));
        m_in_leg = false;
        m_meter.end_leg(m_run->steps(), m_run->now().last().residual);
    }
    return {};
}

/// With the yarns as they lie, where somebody wants them.
void LocalWork::finish() {
    if (m_inbox.finish() == Finish::leave) return;
    if (m_run->now().is_flipping()) m_run->now().end_flip();
    m_step = m_run->steps();
    tell_standing(RunPhase::stopped);
}

// ---- Between two legs ----

Status LocalWork::make_change() {
    const Order change = std::move(m_changes.front());
    m_changes.pop_front();
    m_stands = false;
    if (const auto* one = std::get_if<Flip>(&change)) return flip(*one);
    if (const Status made = make(change); !made) m_outbox.tell(ChangeRefused{made.error()});
    return {};
}

Status LocalWork::make(const Order& change) {
    if (const auto* parameters = std::get_if<wire::Parameters>(&change)) {
        WEAVE_CHECK_OK(m_run->change(parameters->warp, parameters->weft));
        m_leads = true;
        return {};
    }
    const auto& repeats = m_run->now().plan().repeats;
    WEAVE_CHECK_OK(check_room_for(repeats[0] * repeats[1]));
    if (const auto* pins = std::get_if<wire::Pins>(&change)) return m_run->hold(pins->pins);
    return m_run->push(std::get<wire::Fields>(change).fields);
}

/// Errors: the whole cloth, which a flip needs, cannot be planned.
Status LocalWork::flip(const Flip& flip) {
    const auto& repeats = m_run->now().plan().repeats;
    if (const Status room = check_room_for(repeats[0] * repeats[1]); !room) {
        m_outbox.tell(FlipEnd{flip, false, room.error().text()});
        return {};
    }
    m_is_flipping = true;
    m_meter.see_flip(true);
    m_meter.go_on();
    m_outbox.tell(m_meter.take());
    const Status made = m_run->flip(flip, [this](const sim::Progress& progress) { return watch(progress); });
    if (m_run->now().is_flipping())
        m_run->now().end_flip();  // looked at as it lies: the whole may be long in coming to rest
    m_is_flipping = false;
    m_meter.see_flip(false);
    if (!made) {
        m_outbox.tell(FlipEnd{flip, false, made.error().text()});
        return {};
    }
    const Json& flips = m_run->now().flips();
    if (flips.empty()) return {};
    m_outbox.tell(
        FlipEnd{flip, flips.back().at("done").get<bool>(), flips.back().at("reason").get<std::string>()});
    return {};
}

void LocalWork::tell_arrival() {
    if (!m_leads || !m_run->now().parameters().have_arrived()) return;
    m_leads = false;
    m_outbox.tell(ParametersArrived{});
}

RunPhase LocalWork::standing_phase() const {
    return m_run->now().is_at_rest() && !m_run->is_coarse() ? RunPhase::at_rest : RunPhase::paused;
}

/// Nothing is to be done until somebody asks for it.
void LocalWork::rest() {
    tell_standing(standing_phase());
    wait();
}

// ---- During a leg ----

bool LocalWork::watch(const sim::Progress& progress) {
    const bool is_told = progress.iteration > 0 || progress.residual > 0;  // a flip under way tells nothing
    if (is_told) {
        m_step = m_run->now().steps_before() + progress.iteration;
        m_meter.go_on();
        m_meter.pass_step(m_step, progress.residual);
        if (progress.lost_crossings) m_meter.see_lost(*progress.lost_crossings);
    }
    hear();
    if (m_inbox.finish() != Finish::no) return false;
    if (!is_told || m_step <= m_leg_began) return true;
    show_if_due();
    return stand_still();
}

/// Stays here while the run is paused. False: the leg is to end, for a change or for good.
bool LocalWork::stand_still() {
    while (true) {
        hear();
        if (m_inbox.finish() != Finish::no) return false;
        if (!m_changes.empty()) return false;
        if (goes_on()) break;
        tell_standing(RunPhase::paused);
        wait();
    }
    m_stands = false;
    tell_phase(RunPhase::running);
    return true;
}

// ---- What is asked for ----

bool LocalWork::goes_on() const {
    return m_runs && (!m_pause_at || m_step < *m_pause_at);
}

void LocalWork::hear() {
    for (Order& order : m_inbox.take()) hear(std::move(order));
}

void LocalWork::hear(Order&& order) {
    if (std::holds_alternative<RunOrder>(order)) {
        m_runs = true;
        m_pause_at.reset();
    } else if (std::holds_alternative<PauseOrder>(order)) {
        m_runs = false;
        m_pause_at.reset();
    } else if (const auto* steps = std::get_if<StepOrder>(&order)) {
        m_runs = true;
        m_pause_at =
            std::max(m_step, m_pause_at.value_or(m_step)) + std::min(steps->steps, wire::most_number);
    } else {
        m_changes.push_back(std::move(order));
    }
}

void LocalWork::wait() {
    m_meter.stand();
    m_inbox.wait();
    hear();
    if (goes_on()) m_meter.go_on();
}

// ---- What is told ----

void LocalWork::tell_phase(RunPhase phase) {
    if (m_phase == phase) return;
    m_phase = phase;
    if (phase == RunPhase::running) m_meter.go_on();
    m_outbox.tell(phase);
}

void LocalWork::tell_layout() {
    const sim::LedParameters& parameters = m_run->now().parameters();
    const Laid laid{m_run->level(), parameters.wanted(System::warp).radius,
                    parameters.wanted(System::weft).radius};
    if (m_laid == laid) return;
    m_laid = laid;
    YarnLayout layout = wire::layout_of(*m_run);
    layout.layout = ++m_layout;
    m_outbox.tell(std::make_shared<const YarnLayout>(std::move(layout)));
}

void LocalWork::show_if_due() {
    if (Clock::now() - m_last_shown >= between_frames) show(false);
}

void LocalWork::show(bool is_last) {
    m_last_shown = Clock::now();
    tell_layout();
    Frame frame = wire::frame_of(*m_run);
    frame.head.number = ++m_frame;
    frame.head.step = m_step;
    frame.head.residual = std::min(m_meter.residual(), 1e300);
    frame.head.layout = static_cast<std::uint32_t>(m_layout);
    frame.head.at_rest = is_last && !m_in_leg && standing_phase() == RunPhase::at_rest;
    frame.head.is_last = is_last;
    frame.head.is_flipping = m_is_flipping;
    m_outbox.tell(m_meter.take());
    m_outbox.tell(std::make_shared<const Frame>(std::move(frame)));
}

/// Once, until it moves again: how it lies, and what there is to know of it.
void LocalWork::tell_standing(RunPhase phase) {
    if (std::exchange(m_stands, true) && phase != RunPhase::stopped) return tell_phase(phase);
    m_meter.stand();
    show(true);
    if (phase == RunPhase::stopped) {  // nothing is heard of a run after that
        if (m_step > 0) tell_yarns();
        return tell_phase(phase);
    }
    tell_phase(phase);
    if (m_step > 0) tell_yarns();
}

void LocalWork::tell_yarns() {
    auto yarns = std::make_shared<Yarns>(m_run->yarns());
    if (m_in_leg && m_phase == RunPhase::paused) {  // of the leg under way the run's report knows nothing yet
        yarns->report["converged"] = false;
        yarns->report["ending"] = std::string(sim::name_of(sim::Ending::stopped));
        yarns->report["iterations"] = m_step;
        yarns->report["residual"] = m_meter.residual();
    }
    m_outbox.tell(std::shared_ptr<const Yarns>(yarns));
    if (m_in_leg || !m_run->is_over()) return;
    if (auto inspection = inspect(*yarns))
        m_outbox.tell(Inspected{yarns, std::make_shared<const Inspection>(std::move(*inspection))});
}

}  // namespace weave::studio
