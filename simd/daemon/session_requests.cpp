#include <weave/core/log.hpp>
#include <weave/wire/frame.hpp>

#include <algorithm>
#include <simd/daemon/session.hpp>
#include <tuple>
#include <utility>

namespace weave::simd {

namespace {

constexpr std::uint64_t most_unacknowledged = 10'000;
constexpr std::size_t events_at_once = 1000;
/// Faults of the worker, none of which got further than the one before, after which a session is given up.
constexpr std::size_t most_faults = 3;

/// The end of a session is told to whoever comes, but not for ever.
std::chrono::seconds kept_after_end(std::chrono::seconds expire) {
    return std::max<std::chrono::seconds>(expire, std::chrono::hours(1));
}

Error no_disk(const Error& error) {
    return {ErrorCode::system, "the disk does not take it: " + error.message, ""};
}

}  // namespace

Session::Session(Surroundings around, const KeptSession& kept, const SessionTask& task, std::vector<JournaledChange> changes)
    : m_around(std::move(around)), m_person(kept.person), m_request(kept.request), m_title(kept.title), m_document(task.document),
      m_number(kept.number), m_changes(std::move(changes)), m_seq(kept.last_seq), m_saved_seq(kept.last_seq), m_acknowledged(kept.acknowledged),
      m_saved_acknowledged(kept.acknowledged), m_frame(kept.state.frame), m_frames_promised(kept.state.frame),
      m_layout(kept.state.layout), m_step(kept.state.step), m_runs(kept.state.phase == "running"), m_pause_at(kept.state.pause_at),
      m_checkpoint_step(kept.state.checkpoint_step), m_takes_up(true), m_has_ended(kept.ended) {
    m_around.folder /= std::to_string(m_number);
    if (auto work = simulation_from(task.simulation)) m_simulation = std::move(work->simulation);
}

/// What the newest layout and the newest phase say, which the store keeps even when they are acknowledged.
Status Session::remember_events() {
    for (std::uint64_t after = 0;;) {
        WEAVE_TRY(const std::vector<Event> events, m_around.store.events_after(m_number, after, events_at_once));
        for (const Event& event : events) {
            if (event.kind != EventKind::layout && event.kind != EventKind::phase) continue;
            auto read = wire::read_server_message(event.text);
            if (!read) return std::move(read).error().in("the events of session " + std::to_string(m_number));
            if (const auto* changed = std::get_if<wire::PhaseChanged>(&*read)) m_phase = changed->phase;
            if (const auto* layout = std::get_if<wire::Layout>(&*read)) {
                m_layout = layout->layout;
                m_layout_sha256 = layout_sha256(*layout);
            }
        }
        if (events.size() < events_at_once) return {};
        after = events.back().seq;
    }
}

wire::SessionSummary Session::summary(std::chrono::seconds expire) const {
    const auto residual = m_step > 0 ? std::optional(m_residual) : std::nullopt;
    return {m_number, m_title, m_phase, m_step, residual, std::max<std::uint64_t>(1, m_points), m_viewers.size(), m_has_ended, left_s(expire)};
}

/// Until it is ended, or one that has ended is forgotten, if nobody comes; nothing while somebody is attached.
std::optional<double> Session::left_s(std::chrono::seconds expire) const {
    if (!m_viewers.empty()) return {};
    const auto until = m_has_ended ? std::max(m_seen, m_ended_at) + kept_after_end(expire) : m_seen + expire;
    return std::max(0.0, std::chrono::duration<double>(until - Clock::now()).count());
}

Json Session::status(bool with_names) const {
    constexpr const char* phases[]{"running", "paused", "at_rest"};
    Json told{{"session", m_number},
              {"phase", m_has_ended ? "ended" : !m_worker ? "waiting" : phases[static_cast<int>(m_phase)]},
              {"step", m_step},
              {"residual", m_residual},
              {"points", m_points},
              {"steps_per_second", m_phase == wire::Phase::running ? m_rate.per_second(Clock::now()) : 0.0},
              {"clients", m_viewers.size()},
              {"memory_bytes", m_worker ? m_around.crew.memory_bytes(*m_worker) : 0},
              {"computed_s", m_worker ? m_around.crew.turns().spent_s(*m_worker, Clock::now()) : 0.0},
              {"checkpoint_step", m_checkpoint_step},
              {"frames", m_frame}};
    if (!with_names) return told;
    told["person"] = m_person;
    told["title"] = m_title;
    if (m_worker) {
        if (const auto process = m_around.crew.process(*m_worker)) told["worker"] = *process;
    }
    return told;
}

// ---- Answers ----

void Session::answer(const ClientPtr& client, const std::string& request) {
    const std::string text = wire::write_message(wire::Accepted{request, {}, {}, {}});
    const Status remembered = m_around.store.remember(client->person(), request, text);
    if (!remembered) return refuse(client, request, no_disk(remembered.error()));
    client->tell(net::make_bytes(text));
}

void Session::refuse(const ClientPtr& client, const std::string& request, Error error) const {
    client->tell(wire::Refused{request, std::move(error), {}});
}

void Session::post(const Json& message) {
    if (m_worker) m_around.crew.post(*m_worker, message);
}

// ---- Who looks on ----

void Session::attach(const ClientPtr& client, const wire::Attach& attach) {
    if (attach.seq > m_seq || attach.frame > std::max(m_frame, m_frames_promised))
        return refuse(client, attach.request, {ErrorCode::usage, "has had fewer events and frames than that", "session " + std::to_string(m_number)});
    client->tell(wire::Accepted{attach.request, m_number, {}, {}});
    client->session = m_number;
    m_ended_at = Clock::now();  // where it has: there is time to take the end in
    m_viewers.push_back({client, attach.seq, attach.frame, false});
    bring_up(m_viewers.back());
    tell_rates();
}

void Session::leave(const ClientPtr& client) {
    std::erase(m_creators, client);
    if (m_creator == client) m_creator.reset();
    if (std::erase_if(m_viewers, [&](const Viewer& viewer) { return viewer.client == client; }) == 0) return;
    m_seen = Clock::now();
    tell_rates();
}

/// The worker makes frames for the fastest of those that look on.
void Session::tell_rates() {
    double fastest = 0;
    for (const Viewer& viewer : m_viewers) fastest = std::max(fastest, viewer.client->frames_per_second());
    post({{"do", "frames"}, {"per_second", fastest}});
}

void Session::want_frames(const ClientPtr& client, const wire::WantFrames& want) {
    client->want_frames(want.most_per_second);
    tell_rates();
    client->tell(wire::Accepted{want.request, {}, {}, {}});
}

void Session::read_state(const ClientPtr& client, const std::string& request) const {
    client->tell(wire::State{request, m_number, m_phase, m_step, m_seq, m_frame, m_layout, m_residual, m_lost});
}

// ---- What is to be done with it ----

void Session::go_on(const ClientPtr& client, const std::string& request, std::optional<std::uint64_t> steps) {
    if (m_has_ended) return refuse(client, request, gone());
    const auto before = std::pair(m_runs, m_pause_at);
    m_runs = true;
    m_pause_at.reset();
    // Where the worker is it knows alone, and tells where it will pause; until then the last that is known stands for it.
    if (steps) m_pause_at = std::min(wire::most_number, m_step + std::min(*steps, wire::most_number));
    if (const Status saved = save_state(); !saved) {
        std::tie(m_runs, m_pause_at) = before;
        return refuse(client, request, no_disk(saved.error()));
    }
    answer(client, request);
    m_steps_id = steps ? ++m_last_id : 0;
    post({{"do", "go_on"}, {"steps", steps ? Json(std::min(*steps, wire::most_number)) : Json()}, {"id", m_steps_id}});
}

void Session::pause(const ClientPtr& client, const std::string& request) {
    if (m_has_ended) return refuse(client, request, gone());
    m_runs = false;
    m_pause_at = m_step;
    m_steps_id = 0;
    // With a full disk too: at worst it goes on after a fault of the daemon, and a repeated request pauses it again.
    static_cast<void>(save_state());
    const std::string text = wire::write_message(wire::Accepted{request, {}, {}, {}});
    static_cast<void>(m_around.store.remember(client->person(), request, text));
    client->tell(net::make_bytes(text));
    post({{"do", "pause"}});
}

bool Session::unfolds_for(const wire::Change& change) const {
    return m_repeats > 1 && !std::holds_alternative<wire::Parameters>(change);
}

std::optional<Error> Session::why_no_change(const wire::Change& change) const {
    if (m_has_ended) return gone();
    const std::uint64_t left = m_seq - m_acknowledged;
    if (left >= most_unacknowledged)
        return Error{ErrorCode::refused, "its clients have left " + std::to_string(left) + " events unacknowledged", "session " + std::to_string(m_number)};
    if (!unfolds_for(change) || !m_worker) return {};
    Room& room = m_around.crew.room();
    const std::uint64_t own = room.promised(*m_worker);
    if (m_unfolded_bytes <= room.left() + own) return {};
    return Error{ErrorCode::refused,
                 "for this the whole cloth is simulated, which needs " + memory_text(m_unfolded_bytes) + ", and " + memory_text(room.left() + own) + " are free",
                 "change"};
}

void Session::change(const ClientPtr& client, const wire::MakeChange& make) {
    if (auto error = why_no_change(make.change)) return refuse(client, make.request, std::move(*error));
    const std::string text = wire::write_message(wire::Accepted{make.request, {}, {}, {}});
    const auto made = m_around.store.add_change(m_number, make.request, change_text(make.change), [&](std::uint64_t) { return text; });
    if (!made) return refuse(client, make.request, no_disk(made.error()));
    m_changes.push_back({made->number, make.request, make.change, {}, false});
    client->tell(net::make_bytes(text));
    if (m_worker && unfolds_for(make.change)) {
        m_around.crew.admit(*m_worker, m_unfolded_bytes, {{"number", m_number}, {"folder", m_around.folder.string()}});
        m_repeats = 1;
    }
    post({{"do", "change"}, {"change", to_json(m_changes.back())}});
}

void Session::checkpoint(const ClientPtr& client, const std::string& request) {
    if (m_has_ended || !m_worker) return refuse(client, request, m_has_ended ? gone() : Error{ErrorCode::refused, "waits for room", "session"});
    for (auto& [id, waiting] : m_checkpoint_requests) {  // asked again, on another connection, while it is being written
        if (waiting.second != request) continue;
        waiting.first = client;
        return;
    }
    m_checkpoint_requests[++m_last_id] = {client, request};
    post({{"do", "checkpoint"}, {"id", m_last_id}});
}

void Session::close(const ClientPtr& client, const std::string& request) {
    if (m_has_ended) return refuse(client, request, gone());
    answer(client, request);
    m_is_closing = true;
    if (!m_worker) return end(wire::Why::closed, m_step, {}, Json::object());
    m_around.crew.ask_to_end(*m_worker, true);
}

void Session::write_yarns(std::function<void(Result<std::filesystem::path>)> done) {
    if (m_has_ended || !m_worker) return done(m_has_ended ? gone() : Error{ErrorCode::refused, "waits for room", "session"});
    m_yarns_requests[++m_last_id] = std::move(done);
    post({{"do", "yarns"}, {"id", m_last_id}, {"path", (m_around.folder / ("state-" + std::to_string(m_last_id) + ".yarns")).string()}});
}

void Session::fail_waiting(const Error& error) {
    for (auto& [id, request] : std::exchange(m_checkpoint_requests, {})) refuse(request.first, request.second, error);
    for (auto& [id, done] : std::exchange(m_yarns_requests, {})) done(error);
}

// ---- The worker's life ----

WorkOrder Session::order() {
    WorkOrder order;
    order.number = std::max<std::uint64_t>(1, m_number);
    order.document = m_document;
    order.simulation = m_simulation;
    order.folder = m_around.folder.string();
    order.takes_up = m_takes_up;
    order.changes = m_changes;
    order.runs = true;
    order.pause_at = m_pause_at;
    order.frame = m_frame;
    order.layout = m_layout;
    order.layout_sha256 = m_layout_sha256;
    return order;
}

void Session::take_up() {
    if (m_has_ended || m_worker) return;
    m_takes_up = m_is_recovering = true;
    m_worker = m_around.crew.hire(*this, m_person, false);
}

void Session::put_away() {
    m_is_put_away = true;
    if (m_worker) m_around.crew.ask_to_end(*m_worker, false);
}

void Session::ended(const WorkerEnd& end) {
    m_worker.reset();
    if (m_has_ended || m_is_put_away) return;
    const Error why = end.failure.value_or(system_fault("the worker " + end.how));
    if (!is_accepted()) return refuse_creation(why, {});
    fail_waiting(why);
    if (m_is_closing) return this->end(wire::Why::closed, m_step, why, Json::object());
    m_faults = m_step > m_furthest ? 1 : m_faults + 1;
    m_furthest = std::max(m_furthest, m_step);
    log(LogLevel::warning, "session " + std::to_string(m_number) + ": " + why.text());
    if (!end.is_final && m_faults <= most_faults) return take_up();
    this->end(wire::Why::failed, m_step,
              end.is_final ? why : Error{why.code, why.message + ", " + std::to_string(m_faults) + " times in a row without getting further", why.where},
              Json::object());
}

void Session::tick(Clock::time_point now, std::chrono::seconds expire) {
    constexpr std::chrono::seconds to_take_the_end_in{10};
    for (Viewer& viewer : m_viewers) bring_up(viewer);
    if (m_has_ended && !m_viewers.empty() && now - m_ended_at > to_take_the_end_in) say_goodbye();
    if (m_has_ended && m_viewers.empty() && is_written() && now - std::max(m_seen, m_ended_at) > kept_after_end(expire)) m_is_over = true;
    if (!is_accepted() || m_has_ended) return;
    if (!m_worker && !m_is_put_away && m_around.crew.room().left() >= m_bytes) take_up();
    if (m_viewers.empty() && now - m_seen > expire) end(wire::Why::expired, m_step, {}, Json::object());
}

}  // namespace weave::simd
