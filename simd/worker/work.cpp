#include <simd/worker/work.hpp>

#include <weave/core/file.hpp>
#include <weave/core/instrumented.hpp>
#include <weave/core/log.hpp>
#include <weave/core/sha256.hpp>
#include <weave/design/document.hpp>
#include <weave/sim/forecast.hpp>
#include <weave/sim/yarns_file.hpp>
#include <weave/wire/frame.hpp>
#include <weave/wire/shown.hpp>

#include <algorithm>
#include <simd/link/error_form.hpp>
#include <simd/worker/memory.hpp>
#include <new>
#include <utility>

namespace weave::simd {

namespace {

/// How often progress is told.
constexpr std::chrono::milliseconds between_tellings{200};
/// On a machine that is busy a leg may last long. It ends then before its steps are made, with a checkpoint, so that none gets too
/// old; the run is another one from there on than on an idle machine, by as much as a leg's end changes it. Time for which it was
/// paused does not count. In a build that is watched, at some tenth of the pace, legs are to last as they do in others.
constexpr std::chrono::seconds longest_leg{is_instrumented ? 600 : 24};

sim::RunRequest run_request(const WorkOrder& order) {
    sim::RunRequest request;
    request.plan = order.simulation.plan;
    request.goal.solver = order.simulation.solver;
    request.goal.residual = order.simulation.residual;
    if (const auto backend = sim::parse_backend(order.backend)) request.goal.backend = *backend;
    // A session goes on as long as somebody wants it to.
    const std::size_t usual = order.is_job ? sim::usual_iterations(order.simulation.solver) : wire::most_number;
    request.goal.most_iterations = order.simulation.most_steps.value_or(usual);
    request.goal.most_seconds = order.simulation.most_seconds.value_or(1e30);
    request.start_from = order.simulation.start_from;
    request.flips = order.flips;
    return request;
}

/// An error of planning at its place in what was asked for.
Error in_message(Error error) {
    if (error.where == "region") error.where = "simulation.plan.region";
    if (error.where == "start_from") error.where = "simulation.start_from";
    if (error.where == "pins") error.where = "simulation.plan.held";
    return error;
}

}  // namespace

Work::Work(Link& link, WorkOrder order)
    : m_link(link), m_order(std::move(order)), m_folder(m_order.folder), m_inbox(link), m_request(run_request(m_order)),
      m_frame(m_order.frame), m_layout(m_order.layout), m_layout_sha256(m_order.layout_sha256) {
    m_inbox.begin(m_order);
}

Status Work::run() {
    WEAVE_CHECK_OK(limit_memory(m_order.planning_bytes));
    try {
        WEAVE_CHECK_OK(begin());
    } catch (const std::bad_alloc&) {
        return system_fault("out of memory: to lay it out takes more of it than the " + sim::memory_text(m_order.planning_bytes) + " that a plan may have; simulate a part of the cloth");
    }
    WEAVE_CHECK_OK(wait_for_admission());
    if (m_inbox.finish() != Finish::no) return finish();
    WEAVE_CHECK_OK(loop());
    return finish();
}

// ---- The beginning ----

Status Work::begin() {
    auto read_design = read_document(m_order.document);
    if (!read_design) return std::move(read_design).error().in("document");
    const Design design = std::move(*read_design);
    if (!m_order.takes_up) return begin_anew(design);
    auto read = read_checkpoint(m_folder);
    if (!read) log(LogLevel::warning, read.error().text() + ": it begins anew, with its changes at their steps");
    std::optional<Checkpoint> checkpoint = read ? std::move(*read) : std::optional<Checkpoint>();
    if (!checkpoint) return begin_anew(design);
    auto resumed = sim::Run::resume(design, m_request, checkpoint->run, 1);
    if (!resumed) return begin_anew(design);
    m_run = std::move(*resumed);
    m_inbox.skip_changes(checkpoint->changes);
    m_changes_made = checkpoint->changes;
    m_kept = std::move(*checkpoint);
    m_saved = true;
    m_saved_step = m_kept.step;
    m_saved_changes = m_kept.changes;
    m_residual = m_run->now().last().residual;
    return {};
}

Status Work::begin_anew(const Design& design) {
    auto run = sim::Run::begin(design, m_request, 1);
    if (!run) return in_message(std::move(run).error());
    m_run = std::move(*run);
    return {};
}

/// Tells what was planned, and waits until the daemon has room for it.
Status Work::wait_for_admission() {
    const sim::Plan& plan = m_run->now().plan();
    const std::size_t repeats = plan.repeats[0] * plan.repeats[1];
    tell({{"say", "planned"},
          {"title", m_run->now().design().title},
          {"points", sim::points_of(plan)},
          {"repeats", repeats},
          {"bytes", sim::expected_bytes(plan)},
          {"unfolded_bytes", sim::expected_bytes(repeats * sim::points_of(plan))},
          {"step", m_run->steps()},
          {"changes", m_changes_made}});
    while (!m_inbox.admitted()) {
        m_inbox.wait({});
        if (m_inbox.finish() != Finish::no) return {};
    }
    const Json granted = *m_inbox.admitted();
    m_order.number = granted.at("number");
    m_folder = granted.at("folder").get<std::string>();
    return {};
}

// ---- The work ----

Status Work::loop() {
    while (m_inbox.finish() == Finish::no) {
        if (m_level != m_run->level()) {
            m_level = m_run->level();
            m_leg_steps = sim::leg_steps(m_run->now().plan(), m_request.goal.solver);
        }
        m_step = m_run->steps();
        if (m_run->settle_between()) continue;
        tell_layout();
        keep_state();
        if (m_inbox.change_is_due(m_step)) {
            if (!hold_turn()) continue;
            WEAVE_CHECK_OK(make_changes());
            continue;
        }
        answer_requests();
        if (m_run->is_over() && m_order.is_job) return {};
        if (m_run->is_over() || !m_inbox.goes_on(m_step)) {
            rest();
            continue;
        }
        if (!hold_turn()) continue;
        tell_phase(wire::Phase::running);
        m_run->use_threads(m_inbox.turn().value_or(1));
        m_leg_began = m_step;
        m_leg_cut = Clock::now() + longest_leg;
        m_shown_last = false;  // what was shown last is not what it comes to now, however short the leg
        WEAVE_CHECK_OK(m_run->advance(m_leg_steps, [this](const sim::Progress& progress) { return watch(progress); }));
        m_residual = m_run->now().last().residual;
    }
    return {};
}

void Work::keep_state() {
    m_kept = {m_step, m_changes_made, m_run->state()};
    save_if_due(std::exchange(m_leg_was_long, false));
}

void Work::save_if_due(bool now) {
    if (m_saved && m_saved_step == m_kept.step && m_saved_changes == m_kept.changes) return;
    if (!now && Clock::now() - m_last_saved < std::chrono::seconds(m_order.checkpoint_s)) return;
    save({{"say", "checkpoint"}});
}

/// Writes the checkpoint, and tells how that went.
void Work::save(Json told) {
    m_last_saved = Clock::now();
    const Status saved = write_checkpoint(m_folder, m_kept);
    if (saved) {
        m_saved = true;
        m_saved_step = m_kept.step;
        m_saved_changes = m_kept.changes;
    } else {
        told["error"] = to_json(saved.error());
    }
    told["step"] = m_kept.step;
    told["changes"] = m_kept.changes;
    tell(told);
}

Status Work::make_changes() {
    while (auto change = m_inbox.take_change(m_step)) {
        m_shown_last = false;
        Status made;
        if (const auto* parameters = std::get_if<wire::Parameters>(&change->change)) made = m_run->change(parameters->warp, parameters->weft);
        if (const auto* pins = std::get_if<wire::Pins>(&change->change)) made = m_run->hold(pins->pins);
        if (const auto* fields = std::get_if<wire::Fields>(&change->change)) made = m_run->push(fields->fields);
        const auto* flip = std::get_if<Flip>(&change->change);
        m_changes_made = change->number;
        tell_made(*change, made);
        if (flip == nullptr) continue;
        m_is_flipping = true;
        show_if_due();
        m_leg_cut = Clock::now() + longest_leg;
        WEAVE_CHECK_OK(m_run->flip(*flip, [this](const sim::Progress& progress) { return watch(progress); }));
        if (m_run->now().is_flipping()) m_run->now().end_flip();  // looked at as it lies: the whole may be long in coming to rest
        m_is_flipping = false;
        tell_flip_end(*change);
        return {};  // it took steps: what comes next is due at another one
    }
    return {};
}

/// Tells that a change took effect, unless that was told before a fault.
void Work::tell_made(const JournaledChange& change, const Status& made) {
    if (change.step) return;
    wire::Applied applied{.step = m_step, .request = change.request, .change = change.change, .error = {}};
    if (!made) applied.error = made.error();
    tell_event(applied, {{"applied", change.number}, {"step", m_step}});
}

void Work::tell_flip_end(const JournaledChange& change) {
    const Json& flips = m_run->now().flips();
    if (change.flip_told || flips.empty()) return;
    tell_event(wire::Flipped{.step = m_run->steps(), .request = change.request, .done = flips.back().at("done").get<bool>(),
                             .reason = flips.back().at("reason").get<std::string>()},
               {{"flipped", change.number}});
}

wire::Phase Work::standing_phase() const {
    return m_run->now().is_at_rest() && !m_run->is_coarse() ? wire::Phase::at_rest : wire::Phase::paused;
}

/// Nothing is to be done until somebody asks for it.
void Work::rest() {
    give_turn_back();
    tell_phase(standing_phase());
    save_if_due(true);
    show(true);
    if (m_inbox.change_is_due(m_step) || m_inbox.finish() != Finish::no) return;
    m_inbox.wait({});
    if (m_inbox.take_newly_watched()) m_shown_last = false;
}

// ---- During a leg ----

bool Work::watch(const sim::Progress& progress) {
    const bool is_told = progress.iteration > 0 || progress.residual > 0;  // a flip under way tells nothing
    if (is_told) {
        m_step = m_run->now().steps_before() + progress.iteration;
        m_residual = progress.residual;
        m_lost = progress.lost_crossings;
    }
    tell_progress(false);
    if (m_inbox.finish() != Finish::no) return false;
    const bool made_a_step = is_told && m_step > m_leg_began;
    if (!made_a_step) return m_inbox.must_yield() && is_told ? stand_still() : true;
    if (m_inbox.change_is_due(m_step)) return false;
    show_if_due();
    m_leg_was_long = may_cut_legs() && Clock::now() > m_leg_cut;
    return !m_leg_was_long && stand_still();
}

/// A period that relaxes would begin its search anew.
bool Work::may_cut_legs() const {
    const sim::Plan& plan = m_run->now().plan();
    return !plan.rim_force_N[0] && !plan.rim_force_N[1];
}

/// Answers what is asked, and stays here while the session is paused or others have the turn. False: the leg is to end.
bool Work::stand_still() {
    while (true) {
        answer_requests();
        if (m_inbox.finish() != Finish::no) return false;
        const bool is_step = m_step > m_leg_began;
        if (is_step && m_inbox.change_is_due(m_step)) return false;
        if (is_step && !m_inbox.goes_on(m_step)) {
            give_turn_back();
            tell_phase(wire::Phase::paused);
            show(true);
            const auto paused = Clock::now();
            m_inbox.wait({});
            m_leg_cut += Clock::now() - paused;
            if (m_inbox.take_newly_watched()) m_shown_last = false;
            continue;
        }
        if (!m_has_turn || m_inbox.must_yield()) {
            if (!hold_turn()) return false;
            continue;
        }
        tell_phase(wire::Phase::running);
        m_shown_last = false;
        return true;
    }
}

/// Waits for the right to compute; false where the work is to end instead.
bool Work::hold_turn() {
    const bool again = m_has_turn && m_inbox.must_yield();
    if (m_has_turn && !again) return true;
    m_has_turn = false;
    m_inbox.turn_given_back();
    tell({{"say", "turn"}, {"again", again}});
    while (true) {
        if (m_inbox.finish() != Finish::no) return false;
        if (m_inbox.turn()) break;
        m_inbox.wait({});
        answer_requests();
    }
    m_has_turn = true;
    return true;
}

void Work::give_turn_back() {
    if (!m_has_turn) return;
    m_has_turn = false;
    m_inbox.turn_given_back();
    tell({{"say", "turn_over"}});
}

// ---- What is told ----

void Work::tell(const Json& message) {
    static_cast<void>(m_link.send(message));  // a daemon that is gone ends the work by the inbox
}

void Work::tell_event(const wire::ServerMessage& event, Json more) {
    more["say"] = "event";
    more["event"] = wire::write_message(event);
    tell(more);
}

void Work::tell_layout() {
    const sim::LedParameters& parameters = m_run->now().parameters();
    const Laid laid{m_run->level(), parameters.wanted(System::warp).radius, parameters.wanted(System::weft).radius};
    if (m_order.is_job || m_laid == laid) return;
    m_laid = laid;
    wire::Layout layout = wire::layout_of(*m_run);
    std::string sha256 = layout_sha256(layout);
    if (sha256 == m_layout_sha256) return;
    m_layout_sha256 = std::move(sha256);
    layout.layout = ++m_layout;
    const sim::Plan& plan = m_run->now().plan();
    tell_event(layout, {{"layout", m_layout}, {"layout_sha256", m_layout_sha256}, {"points", sim::points_of(plan)}, {"bytes", sim::expected_bytes(plan)}});
}

void Work::tell_phase(wire::Phase phase) {
    if (m_phase == phase) return;
    m_phase = phase;
    tell_progress(true);
    tell_event(wire::PhaseChanged{.step = m_step, .phase = phase}, {{"phase", static_cast<int>(phase)}, {"step", m_step}});
}

void Work::tell_progress(bool now) {
    if (!now && Clock::now() - m_last_told < between_tellings) return;
    m_last_told = Clock::now();
    Json told{{"say", "progress"}, {"step", m_step}, {"residual", m_residual}, {"goal", m_run->now().goal()}};
    if (m_lost) told["lost"] = *m_lost;
    tell(told);
}

void Work::show_if_due() {
    const double rate = m_inbox.frames_per_second();
    if (rate <= 0 || m_order.is_job) return;
    if (std::chrono::duration<double>(Clock::now() - m_last_shown).count() * rate < 1) return;
    show(false);
}

void Work::show(bool is_last) {
    if (m_order.is_job) return;
    if (is_last && std::exchange(m_shown_last, true)) return;
    if (!is_last) m_shown_last = false;
    m_last_shown = Clock::now();
    tell_layout();
    wire::Frame frame = wire::frame_of(*m_run);
    frame.head.session = m_order.number;
    frame.head.number = ++m_frame;
    frame.head.step = m_step;
    frame.head.residual = std::min(m_residual, 1e300);
    if (m_lost) frame.head.lost_crossings = static_cast<std::uint32_t>(std::min<std::uint64_t>(*m_lost, 0xfffffffe));
    frame.head.layout = static_cast<std::uint32_t>(m_layout);
    frame.head.at_rest = is_last && standing_phase() == wire::Phase::at_rest;
    frame.head.is_last = is_last;
    frame.head.is_flipping = m_is_flipping;
    const auto bytes = wire::encode_frame(frame);
    if (bytes) static_cast<void>(m_link.send_frame(*bytes));
    else tell({{"say", "unshown"}, {"error", to_json(bytes.error())}});
}

void Work::answer_requests() {
    for (const Json& request : m_inbox.take_requests()) {
        if (request.at("do") == "checkpoint") save({{"say", "checkpoint"}, {"id", request.at("id")}});  // also one that is there: the disk may have become full
        else answer_yarns(request);
    }
}

void Work::answer_yarns(const Json& request) {
    Json told{{"say", "yarns"}, {"id", request.at("id")}};
    Status written;
    if (const auto bytes = write_yarns(m_run->yarns()); bytes) written = write_file(request.at("path").get<std::string>(), *bytes);
    else written = bytes.error();
    if (!written) told["error"] = to_json(written.error());
    tell(told);
}

// ---- The end ----

Status Work::finish() {
    give_turn_back();
    switch (m_inbox.finish()) {
        case Finish::gone: return {};
        case Finish::keep:
            if (m_kept.run.is_object()) save_if_due(true);
            tell({{"say", "kept"}, {"step", m_saved_step}});
            return {};
        default: break;
    }
    if (m_run->now().is_flipping()) m_run->now().end_flip();  // judged as it lies: the yarns have it, and so are they to say
    Yarns yarns = m_run->yarns();
    Json done{{"say", "done"}, {"step", m_run->steps()}};
    if (m_order.is_job) {
        WEAVE_TRY(const std::string bytes, write_yarns(yarns));
        const std::string name = "result.yarns";
        WEAVE_CHECK_OK(write_file(m_folder / name, bytes));
        yarns.report["yarns_sha256"] = sha256_hex(bytes);
        done["yarns"] = name;
    }
    done["report"] = std::move(yarns.report);
    tell(done);
    return {};
}

}  // namespace weave::simd
