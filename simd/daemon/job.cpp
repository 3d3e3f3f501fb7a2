#include <simd/daemon/job.hpp>

#include <weave/core/log.hpp>

#include <algorithm>
#include <simd/link/error_form.hpp>
#include <utility>

namespace weave::simd {

namespace {

/// Faults of the worker, none of which got further than the one before, after which a job has failed.
constexpr std::size_t most_faults = 3;
constexpr const char* phase_names[]{"waiting", "running", "done", "failed", "cancelled"};

}  // namespace

Job::Job(Surroundings around, KeptJob kept) : m_around(std::move(around)), m_kept(std::move(kept)) {
    m_around.folder /= std::to_string(number());
    if (!m_kept.end) return;
    m_end = *m_kept.end;
    m_phase = static_cast<wire::JobPhase>(m_end.phase);
    m_step = m_kept.step;
    m_residual = m_kept.residual.value_or(0);
    m_is_saved = true;
    if (auto report = parse_json(m_end.report)) m_report = std::move(*report);
    if (!m_end.error) return;
    if (const auto error = parse_json(*m_end.error)) m_error = error_from(*error);
}

Job::~Job() {
    if (m_worker) m_around.crew.dismiss(*m_worker);
    if (m_around.slurm != nullptr) m_around.slurm->part(*this);
}

wire::JobState Job::state() const {
    wire::JobState state;
    state.job = number();
    state.phase = m_phase;
    state.title = m_kept.title;
    state.step = m_step;
    if (m_step > 0) state.residual = m_residual;
    if (m_phase == wire::JobPhase::running) state.lost_crossings = m_lost;
    state.left_s = left_s();
    if (m_is_in_slurm && !is_over()) state.batch = m_around.slurm->place_of(number());
    return state;
}

std::optional<double> Job::left_s() const {
    if (!m_pace || m_phase != wire::JobPhase::running || !m_rate.is_told(Clock::now())) return {};
    return m_pace->seconds_left();
}

wire::JobEnded Job::ending() const {
    wire::JobEnded ending{number(), m_phase, m_error, m_report, {}};
    if (m_end.evidence) {
        if (auto evidence = parse_json(*m_end.evidence)) ending.evidence = std::move(*evidence);
    }
    return ending;
}

std::optional<std::filesystem::path> Job::yarns() const {
    if (!is_over() || !m_end.yarns) return {};
    return m_around.folder / *m_end.yarns;
}

Json Job::status(bool with_names) const {
    const wire::JobState now = state();
    Json told{{"job", number()},
              {"phase", phase_names[static_cast<int>(m_phase)]},
              {"step", now.step},
              {"steps_per_second", m_phase == wire::JobPhase::running ? m_rate.per_second(Clock::now()) : 0.0},
              {"residual", now.residual ? Json(*now.residual) : Json()},
              {"left_s", now.left_s ? Json(*now.left_s) : Json()},
              {"points", m_points},
              {"memory_bytes", m_worker ? m_around.crew.memory_bytes(*m_worker) : 0},
              {"computed_s", m_worker ? m_around.crew.turns().spent_s(*m_worker, Clock::now()) : 0.0}};
    if (!with_names) return told;
    told["person"] = person();
    told["title"] = m_kept.title;
    if (now.batch) told["batch"] = *now.batch;
    if (m_worker) {
        if (const auto process = m_around.crew.process(*m_worker)) told["worker"] = *process;
    }
    return told;
}

// ---- Its work ----

void Job::take_up() {
    m_is_in_slurm = !is_over() && m_around.slurm != nullptr && m_around.slurm->resume(*this, number(), person());
}

void Job::begin() {
    if (m_around.slurm != nullptr) {
        m_is_in_slurm = true;
        return m_around.slurm->hand_over(*this, number(), person());
    }
    auto task = m_around.store.task_of_job(number());
    if (!task) return;
    m_task = std::move(*task);
    m_worker = m_around.crew.hire(*this, person(), true);
}

WorkOrder Job::order() {
    WorkOrder order;
    order.is_job = true;
    order.number = number();
    const JobTask task = std::exchange(m_task, {}).value_or(JobTask{});
    order.document = task.document;
    if (auto work = simulation_from(task.simulation)) {
        order.simulation = std::move(work->simulation);
        order.flips = std::move(work->flips);
        m_has_flips = !order.flips.empty();
    }
    order.folder = m_around.folder.string();
    order.takes_up = true;  // from the checkpoint of an earlier attempt, if there is one
    return order;
}

void Job::planned(const Json& plan) {
    m_points = plan.at("points").get<std::size_t>() * (m_has_flips ? plan.at("repeats").get<std::size_t>() : 1);
    m_bytes = plan.at(m_has_flips ? "unfolded_bytes" : "bytes");
    const std::uint64_t whole = m_around.crew.room().whole();
    if (m_bytes > whole) {
        const Error error{ErrorCode::refused,
                          "the cloth needs " + memory_text(m_bytes) + ", and " + memory_text(whole) +
                              " is all that there is: simulate a part of it, or fewer points",
                          "simulation"};
        return end(wire::JobPhase::failed, error, Json::object(), {});
    }
    std::error_code code;
    std::filesystem::create_directories(m_around.folder, code);
    if (code || !m_around.crew.admit(*m_worker, m_bytes, {{"number", number()}, {"folder", m_around.folder.string()}})) {
        m_around.crew.dismiss(*m_worker);  // its place in the queue is what it was
        m_worker.reset();
        if (m_is_cancelled) return end(wire::JobPhase::cancelled, system_fault("there was no room to put away its yarns"), Json::object(), {});
        m_phase = wire::JobPhase::waiting;
        return;
    }
    if (const std::uint64_t step = plan.at("step"); step > 0)
        log(LogLevel::info, "job " + std::to_string(number()) + " goes on from its checkpoint at step " + std::to_string(step));
    begun();
    if (m_is_cancelled) m_around.crew.ask_to_end(*m_worker, true);
}

void Job::begun() {
    m_phase = wire::JobPhase::running;
    m_began = Clock::now();
    m_pace.reset();
    m_rate = {};
    const Status started = m_around.store.start_job(number());
    if (!started) log(LogLevel::warning, "job " + std::to_string(number()) + ": " + started.error().text());
}

void Job::said(const std::string& what, const Json& message) {
    if (what == "progress") {
        m_step = message.at("step");
        m_residual = std::min(message.at("residual").get<double>(), 1e300);
        m_lost.reset();
        if (message.contains("lost")) m_lost = message.at("lost").get<std::uint64_t>();
        m_rate.add(Clock::now(), m_step);
        const double goal = message.at("goal");
        if (!m_pace) m_pace.emplace(goal);
        m_pace->add(std::chrono::duration<double>(Clock::now() - m_began).count(), m_residual);
    } else if (what == "checkpoint" && !message.contains("error")) {
        m_around.store.job_progress(number(), m_step, m_residual);
    } else if (what == "checkpoint") {
        log(LogLevel::warning, "job " + std::to_string(number()) + ": " + error_from(message.at("error")).text());
    } else if (what == "begun") {  // by a worker of Slurm, which needs no room here
        m_points = message.at("points");
        begun();
    } else if (what == "done") {
        m_is_done = true;
        m_is_cancelled = message.value("was_stopped", m_is_cancelled);  // before this daemon was started, maybe
        m_step = message.at("step");
        const Json& residual = message.at("report").at("residual");
        if (residual.is_number()) m_residual = residual.get<double>();
        m_around.store.job_progress(number(), m_step, m_residual);
        end(m_is_cancelled ? wire::JobPhase::cancelled : wire::JobPhase::done, {}, message.at("report"), message.value("yarns", std::string()));
    }
}

void Job::cancel() {
    if (is_over()) return;
    m_is_cancelled = true;
    if (m_phase == wire::JobPhase::running && m_is_in_slurm) m_around.slurm->stop(number());
    else if (m_phase == wire::JobPhase::running && m_worker) m_around.crew.ask_to_end(*m_worker, true);
    else end(wire::JobPhase::cancelled, {}, Json::object(), {});
}

void Job::put_away() {
    m_is_put_away = true;
    if (m_phase == wire::JobPhase::running && m_worker) m_around.crew.ask_to_end(*m_worker, false);
    else if (m_worker) m_around.crew.dismiss(*std::exchange(m_worker, {}));
}

void Job::ended(const WorkerEnd& end) {
    m_worker.reset();
    m_is_in_slurm = false;
    if (is_over() || m_is_put_away) return;
    const Error why = end.failure.value_or(system_fault("the worker " + end.how));
    log(LogLevel::warning, "job " + std::to_string(number()) + ": " + why.text());
    if (m_is_cancelled) {  // once more, from its checkpoint: its yarns as they lay are promised
        if (m_phase == wire::JobPhase::running && !end.is_final && !std::exchange(m_is_ended_again, true)) return begin();
        return this->end(wire::JobPhase::cancelled, why, Json::object(), {});
    }
    m_phase = wire::JobPhase::waiting;
    if (end.is_final) return this->end(wire::JobPhase::failed, why, Json::object(), {});
    m_faults = m_step > m_furthest ? 1 : m_faults + 1;
    m_furthest = std::max(m_furthest, m_step);
    if (m_faults > most_faults)
        this->end(wire::JobPhase::failed, Error{why.code, why.message + ", " + std::to_string(m_faults) + " times in a row without getting further", why.where},
                  Json::object(), {});
}

// ---- Its end ----

void Job::end(wire::JobPhase phase, std::optional<Error> error, Json report, std::string yarns) {
    if (m_worker && !m_is_done) m_around.crew.dismiss(*std::exchange(m_worker, {}));
    m_is_in_slurm = false;
    if (m_around.slurm != nullptr) m_around.slurm->leave(number());
    m_phase = phase;
    m_error = std::move(error);
    m_report = std::move(report);
    if (!yarns.empty()) m_end.yarns = std::move(yarns);
    if (phase == wire::JobPhase::done && m_around.sign) m_end.evidence = m_around.sign(m_report);
    save_end();
}

/// The end is told once the disk has it.
void Job::save_end() {
    m_end.phase = static_cast<JobPhase>(m_phase);
    m_end.error.reset();
    if (m_error) m_end.error = canonical_json(to_json(*m_error));
    m_end.report = canonical_json(m_report);
    const Status saved = m_around.store.end_job(number(), m_end);
    if (!saved) return log(LogLevel::warning, "job " + std::to_string(number()) + ": " + saved.error().text());
    m_is_saved = true;
    m_around.has_ended(*this);
}

void Job::tick() {
    if (is_over() && !m_is_saved) save_end();
}

}  // namespace weave::simd
