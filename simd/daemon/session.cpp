#include <weave/core/log.hpp>
#include <weave/core/text.hpp>

#include <algorithm>
#include <simd/daemon/session.hpp>
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
      m_simulation(create.simulation), m_creators{client} {
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
    m_repeats = plan.at("repeats");
    m_title = plan.at("title");
    Room& room = m_around.crew.room();
    const std::uint64_t bytes = expected_bytes(m_points);
    if (!is_accepted()) {
        if (bytes > room.left()) {
            const bool ever = bytes <= room.whole();
            return refuse_creation({ErrorCode::refused,
                                    "the cloth needs " + memory_text(bytes) + ", and " + memory_text(ever ? room.left() : room.whole()) +
                                        (ever ? " are free now" : " is all that there is: simulate a part of it, or fewer points"),
                                    "simulation"},
                                   {});
        }
        if (const Status accepted = become_accepted(); !accepted) return refuse_creation(accepted.error(), {});
    }
    if (!m_around.crew.admit(*m_worker, m_points, {{"number", m_number}, {"folder", m_around.folder.string()}})) {
        m_around.crew.dismiss(*m_worker);  // there will be room again: tick() tries
        m_worker.reset();
        return;
    }
    if (std::exchange(m_is_recovering, false)) emit(wire::Recovered{.step = plan.at("step"), .frame = m_frame}, EventKind::other);
    tell_rates();
    if (m_is_closing) post({{"do", "finish"}, {"with_report", true}});
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
        client->session = m_number;
        m_clients.push_back(client);
        client->tell(net::make_bytes(text(m_number)));
    }
    m_creators.clear();
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
    save_unsaved();
}

/// Events are told once the disk has them. While it does not take them, they wait in their order.
void Session::save_unsaved() {
    while (!m_unsaved.empty()) {
        const Unsaved& first = m_unsaved.front();
        const Status saved = m_around.store.add_events(m_number, {first.event}, first.dated ? std::vector{*first.dated} : std::vector<Dated>{});
        if (!saved) {
            log(LogLevel::warning, "session " + std::to_string(m_number) + ": " + saved.error().text());
            return;
        }
        deliver(first);
        m_unsaved.erase(m_unsaved.begin());
    }
}

void Session::deliver(const Unsaved& unsaved) {
    const net::Bytes text = net::make_bytes(unsaved.event.text);
    for (const ClientPtr& client : m_clients) client->tell(text);
}

void Session::say_goodbye() {
    for (const ClientPtr& client : std::exchange(m_clients, {})) client->close(1000, "the session has ended");
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

Status Session::save_state() {
    return m_around.store.change_session(
        m_number, {m_runs ? "running" : "paused", m_step, m_pause_at, m_frames_promised, m_layout, m_checkpoint_step});
}

void Session::acknowledge(std::uint64_t seq) {
    const Status done = m_around.store.acknowledge(m_number, std::min(seq, m_seq));
    if (!done) log(LogLevel::warning, "session " + std::to_string(m_number) + ": " + done.error().text());
    if (!m_has_ended || seq < m_seq || !m_unsaved.empty()) return;
    m_is_over = true;
    say_goodbye();
}

// ---- What the worker says ----

void Session::said(const std::string& what, const Json& message) {
    if (what == "progress") {
        const std::uint64_t step = message.at("step");
        const Clock::time_point now = Clock::now();
        const double passed = std::chrono::duration<double>(now - m_paced.first).count();
        if (passed >= 1) {
            m_pace = step > m_paced.second ? static_cast<double>(step - m_paced.second) / passed : 0;
            m_paced = {now, step};
        }
        m_step = step;
        m_residual = std::min(message.at("residual").get<double>(), 1e300);
        if (message.contains("lost")) m_lost = message.at("lost").get<std::uint64_t>();
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
        return emit(std::move(*read), EventKind::layout);
    }
    if (message.contains("phase")) {
        const auto& changed = std::get<wire::PhaseChanged>(*read);
        m_step = changed.step;
        if (changed.phase == wire::Phase::paused && !m_runs) m_pause_at = changed.step;
        if (changed.phase == wire::Phase::paused && m_runs && m_pause_at == changed.step) m_runs = false;
        if (m_phase == changed.phase && m_seq > 1) return;  // told before a fault
        m_phase = changed.phase;
        static_cast<void>(save_state());
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
    m_frame = little_endian(frame, number_at, 8);
    if (m_frame > m_frames_promised) {
        m_frames_promised = m_frame + frames_at_once;
        if (!save_state()) return;  // a number must not come twice, so it waits for the disk
    }
    const bool is_last = (little_endian(frame, flags_at, 2) & last_flag) != 0;
    m_newest = net::make_bytes(std::move(frame));
    m_newest_number = m_frame;
    for (const ClientPtr& client : m_clients) client->show(m_newest, is_last);
}

}  // namespace weave::simd
