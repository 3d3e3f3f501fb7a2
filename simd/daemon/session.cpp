#include <simd/daemon/session.hpp>

#include <weave/core/log.hpp>

#include <algorithm>
#include <simd/link/error_form.hpp>
#include <utility>

namespace weave::simd {

namespace {

/// So many frames are promised to the store at once, since each promise is a write.
constexpr std::uint64_t frames_at_once = 100'000;

std::uint64_t little_endian(const std::string& bytes, std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t k = 0; k < size; ++k) value |= std::uint64_t(static_cast<unsigned char>(bytes[at + k])) << (8 * k);
    return value;
}

}  // namespace

Error Session::gone() const {
    return {ErrorCode::refused, "has ended", "session " + std::to_string(m_number)};
}

Session::Session(Surroundings around, const wire::Create& create, const ClientPtr& client)
    : m_around(std::move(around)), m_person(client->person()), m_request(create.request), m_document(create.document),
      m_simulation(create.simulation), m_creator(client), m_creators{client} {
    m_pause_at = 0;
    m_worker = m_around.crew.hire(*this, m_person, false);
}

Session::~Session() {
    if (m_worker) m_around.crew.dismiss(*m_worker);
    fail_waiting(gone());
}

// ---- Creation ----

void Session::refuse_creation(Error error, std::optional<double> wait_s) {
    for (const ClientPtr& client : m_creators) client->tell(wire::Refused{m_request, error, wait_s});
    m_creators.clear();
    m_is_over = true;
}

void Session::planned(const Json& plan) {
    // After a fault changes that asked for more are still to be repeated.
    m_points = std::max(m_points, plan.at("points").get<std::size_t>());
    m_bytes = std::max(m_bytes, plan.at("bytes").get<std::uint64_t>());
    m_unfolded_bytes = plan.at("unfolded_bytes");
    m_repeats = plan.at("repeats");
    m_title = plan.at("title");
    Room& room = m_around.crew.room();
    if (!is_accepted()) {
        if (m_bytes > room.left()) {
            const bool ever = m_bytes <= room.whole();
            return refuse_creation({ErrorCode::refused,
                                    "the cloth needs " + memory_text(m_bytes) + ", and " + memory_text(ever ? room.left() : room.whole()) +
                                        (ever ? " are free now" : " is all that there is: simulate a part of it, or fewer points"),
                                    "simulation"},
                                   ever ? m_around.expected_wait_s() : std::nullopt);
        }
        if (const Status accepted = become_accepted(); !accepted) return refuse_creation(accepted.error(), {});
    }
    if (!m_around.crew.admit(*m_worker, m_bytes, {{"number", m_number}, {"folder", m_around.folder.string()}})) {
        m_around.crew.dismiss(*m_worker);  // there will be room again: tick() tries
        m_worker.reset();
        return;
    }
    if (m_takes_up) m_checkpoint_step = plan.at("step");
    if (std::exchange(m_is_recovering, false)) emit(wire::Recovered{.step = plan.at("step"), .frame = m_frame}, EventKind::other);
    tell_rates();
    if (m_is_closing) m_around.crew.ask_to_end(*m_worker, true);
}

Status Session::become_accepted() {
    const auto text = [this](std::uint64_t number) {
        return wire::write_message(wire::Accepted{m_request, number, {}, {}});
    };
    const NewSession fresh{m_person, m_request, m_title, m_document, simulation_text(m_simulation)};
    WEAVE_TRY(const Made made, m_around.store.add_session(fresh, text));
    m_number = made.number;
    m_around.folder /= std::to_string(m_number);
    std::error_code code;
    std::filesystem::create_directories(m_around.folder, code);
    if (code) {
        static_cast<void>(m_around.store.forget_session(m_number));
        m_number = 0;
        return system_fault("cannot make a folder for the session: " + code.message());
    }
    for (const ClientPtr& client : m_creators) {
        client->tell(net::make_bytes(text(m_number)));
        if (client != m_creator || std::exchange(client->session, m_number) != 0) continue;  // once, however often it asked
        m_viewers.push_back({client, 0, 0, false});
    }
    m_creators.clear();
    m_creator.reset();
    return {};
}

// ---- Events ----

void Session::emit(wire::ServerMessage event, EventKind kind, std::optional<Dated> dated) {
    const std::uint64_t seq = ++m_seq;
    std::visit(
        [&](auto& message) {
            if constexpr (requires { message.seq; message.session; }) {
                message.session = m_number;
                message.seq = seq;
            }
        },
        event);
    m_unsaved.push_back({{seq, kind, wire::write_message(event)}, dated});
    m_around.wants_writing();
}

std::optional<Session::Writing> Session::to_write() const {
    if (m_is_over || (m_unsaved.empty() && !m_state_changed && m_acknowledged == m_saved_acknowledged)) return {};
    Writing writing{.number = m_number, .events = {}, .dated = {}, .state = {}, .acknowledged = {}};
    for (const Unsaved& unsaved : m_unsaved) {
        writing.events.push_back(unsaved.event);
        if (unsaved.dated) writing.dated.push_back(*unsaved.dated);
    }
    if (m_state_changed) writing.state = kept_state();
    if (m_acknowledged != m_saved_acknowledged) writing.acknowledged = m_acknowledged;
    return writing;
}

void Session::written(const Writing& writing) {
    if (writing.state && *writing.state == kept_state()) m_state_changed = false;
    m_saved_acknowledged = writing.acknowledged.value_or(m_saved_acknowledged);
    m_unsaved.erase(m_unsaved.begin(), m_unsaved.begin() + static_cast<std::ptrdiff_t>(writing.events.size()));
    for (const Event& event : writing.events) {
        m_saved_seq = event.seq;
        const net::Bytes text = net::make_bytes(event.text);
        for (Viewer& viewer : m_viewers) {
            if (viewer.sent + 1 != event.seq || !viewer.is_shown) continue;  // it is brought up by and by
            viewer.client->tell(text);
            viewer.sent = event.seq;
        }
    }
    for (Viewer& viewer : m_viewers) bring_up(viewer);
    if (m_unsaved.empty()) show_newest();
}

/// Tells a viewer what it has not had, as fast as it takes it.
void Session::bring_up(Viewer& viewer) {
    constexpr std::size_t at_once = 64;
    while (viewer.sent < m_saved_seq) {
        if (viewer.client->is_full()) return;
        const auto events = m_around.store.events_after(m_number, viewer.sent, at_once);
        if (!events) return;  // the next tick tries again
        for (const Event& event : *events) viewer.client->tell(net::make_bytes(event.text));
        viewer.sent = events->empty() ? m_saved_seq : events->back().seq;
    }
    // No frame goes out before an event that waits for the disk: it may be the frame's layout.
    if (viewer.is_shown || !m_unsaved.empty()) return;
    viewer.is_shown = true;
    if (m_newest && m_newest_number > viewer.frame + 1) viewer.client->tell(wire::Gap{m_number, viewer.frame + 1, m_newest_number - 1});
    if (m_newest && m_newest_number > viewer.frame) viewer.client->show(m_newest, true);
    viewer.frame = m_newest_number;
}

/// A frame goes out once every event before it, its layout above all, is told.
void Session::show_newest() {
    for (Viewer& viewer : m_viewers) {
        if (!m_newest || !viewer.is_shown || viewer.sent < m_saved_seq || viewer.frame >= m_newest_number) continue;
        viewer.client->show(m_newest, m_newest_is_last);
        viewer.frame = m_newest_number;
    }
}

void Session::say_goodbye() {
    for (const Viewer& viewer : std::exchange(m_viewers, {})) viewer.client->close(1000, "the session has ended");
}

void Session::end(wire::Why why, std::uint64_t step, std::optional<Error> error, Json report) {
    if (std::exchange(m_has_ended, true)) return;
    m_ended_at = Clock::now();
    m_step = step;
    if (m_worker) m_around.crew.dismiss(*m_worker);
    m_worker.reset();
    fail_waiting(gone());
    emit(wire::Ended{.step = step, .why = why, .error = std::move(error), .report = std::move(report)}, EventKind::ended);
}

SessionState Session::kept_state() const {
    return {m_runs ? "running" : "paused", m_step, m_pause_at, m_frames_promised, m_layout, m_checkpoint_step};
}

Status Session::save_state() {
    return m_around.store.change_session(m_number, kept_state());
}

void Session::acknowledge(std::uint64_t seq) {
    m_acknowledged = std::max(m_acknowledged, std::min(seq, m_saved_seq));  // nobody was told of more
    if (!m_has_ended || seq < m_seq || !m_unsaved.empty()) return;
    m_is_over = true;
    say_goodbye();
}

// ---- What the worker says ----

void Session::said(const std::string& what, const Json& message) {
    if (what == "progress") {
        const std::uint64_t step = message.at("step");
        m_rate.add(Clock::now(), step);
        m_step = step;
        m_residual = std::min(message.at("residual").get<double>(), 1e300);
        if (message.contains("lost")) m_lost = message.at("lost").get<std::uint64_t>();
    } else if (what == "pauses_at") {
        if (message.at("id") != m_steps_id) return;  // somebody asked for something else meanwhile
        m_pause_at = message.at("step").get<std::uint64_t>();
        m_state_changed = true;
        m_around.wants_writing();
    } else if (what == "event") {
        heard_event(message);
    } else if (what == "checkpoint") {
        heard_checkpoint(message);
    } else if (what == "yarns") {
        heard_yarns(message);
    } else if (what == "done") {
        end(wire::Why::closed, message.at("step"), {}, message.at("report"));
    } else if (what == "unshown") {
        const Error error = error_from(message.at("error"));
        end(wire::Why::failed, m_step, Error{error.code, "the cloth cannot be shown: " + error.message, error.where}, Json::object());
    }
}

void Session::heard_event(const Json& message) {
    auto read = wire::read_server_message(message.at("event").get<std::string>());
    if (!read) throw std::runtime_error(read.error().text());
    if (message.contains("layout")) {
        m_layout = message.at("layout");
        m_layout_sha256 = message.at("layout_sha256");
        m_points = message.at("points");
        m_bytes = message.at("bytes");
        return emit(std::move(*read), EventKind::layout);
    }
    if (message.contains("phase")) {
        const auto& changed = std::get<wire::PhaseChanged>(*read);
        m_step = changed.step;
        if (changed.phase == wire::Phase::paused && !m_runs) m_pause_at = changed.step;
        if (changed.phase == wire::Phase::paused && m_runs && m_pause_at == changed.step) m_runs = false;
        if (m_phase == changed.phase && m_seq > 1) return;  // told before a fault
        m_phase = changed.phase;
        m_state_changed = true;
        return emit(std::move(*read), EventKind::phase);
    }
    const bool is_flip = message.contains("flipped");
    const std::uint64_t number = message.at(is_flip ? "flipped" : "applied");
    if (number == 0 || number > m_changes.size()) throw std::runtime_error("no such change");
    JournaledChange& change = m_changes[number - 1];
    if (is_flip) change.flip_told = true;
    else change.step = message.at("step").get<std::uint64_t>();
    emit(std::move(*read), EventKind::other, Dated{number, change.step.value_or(0), change.flip_told});
}

void Session::heard_checkpoint(const Json& message) {
    const bool failed = message.contains("error");
    const std::uint64_t step = message.at("step");
    if (!failed) {
        m_checkpoint_step = step;
    } else {
        log(LogLevel::warning, "session " + std::to_string(m_number) + ": " + error_from(message.at("error")).text());
    }
    if (!message.contains("id")) return;
    const auto found = m_checkpoint_requests.find(message.at("id").get<std::uint64_t>());
    if (found == m_checkpoint_requests.end()) return;
    const auto [client, request] = std::move(found->second);
    m_checkpoint_requests.erase(found);
    if (failed) return refuse(client, request, error_from(message.at("error")));
    answer(client, request);
    emit(wire::Checkpointed{.step = step, .request = request}, EventKind::other);
}

void Session::heard_yarns(const Json& message) {
    const auto found = m_yarns_requests.find(message.at("id").get<std::uint64_t>());
    if (found == m_yarns_requests.end()) return;
    const auto done = std::move(found->second);
    const std::filesystem::path path = m_around.folder / ("state-" + std::to_string(found->first) + ".yarns");
    m_yarns_requests.erase(found);
    if (message.contains("error")) done(error_from(message.at("error")));
    else done(path);
}

void Session::shown(std::string frame) {
    constexpr std::size_t flags_at = 6, number_at = 16, head = 80;
    constexpr std::uint64_t last_flag = 2;
    if (frame.size() < head) throw std::runtime_error("no frame");
    const std::uint64_t number = little_endian(frame, number_at, 8);
    if (number > m_frames_promised) {
        const std::uint64_t promised = std::exchange(m_frames_promised, number + frames_at_once);
        if (!save_state()) {  // a number must not come twice, so it waits for the disk
            m_frames_promised = promised;
            return;
        }
    }
    m_frame = number;
    const bool is_last = (little_endian(frame, flags_at, 2) & last_flag) != 0;
    m_newest = net::make_bytes(std::move(frame));
    m_newest_number = m_frame;
    m_newest_is_last = is_last;
    if (m_unsaved.empty()) show_newest();
}

}  // namespace weave::simd
