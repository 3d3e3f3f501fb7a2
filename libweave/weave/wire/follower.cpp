#include <weave/wire/follower.hpp>

#include <algorithm>
#include <concepts>
#include <random>
#include <thread>
#include <type_traits>
#include <utility>

namespace weave::wire {

namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds first_pause{100}, longest_pause{10'000};
constexpr std::size_t most_waiting = 20'000;
/// Events that a caller may be ahead of what the server knows, while more of them wait.
constexpr std::uint64_t most_unacknowledged = 64;

milliseconds until(Clock::time_point end) {
    return std::max(milliseconds(0), std::chrono::duration_cast<milliseconds>(end - Clock::now()));
}

/// Between half of a pause and all of it, so that those whom a restart cut off do not come back at one moment.
milliseconds jittered(milliseconds pause) {
    static thread_local std::minstd_rand random{std::random_device{}()};
    return milliseconds(std::uniform_int_distribution<milliseconds::rep>(pause.count() / 2, pause.count())(random));
}

template <class M>
concept Event = requires(const M& message) {
    message.session;
    message.seq;
    message.step;
} && !std::same_as<M, State>;

template <class M>
constexpr bool is_event = Event<M> || std::same_as<M, Layout>;

std::uint64_t seq_of(const Received& received) {
    const auto* message = std::get_if<ServerMessage>(&received);
    if (message == nullptr) return 0;
    return std::visit(
        [](const auto& told) -> std::uint64_t {
            if constexpr (is_event<std::decay_t<decltype(told)>>) return told.seq;
            else return 0;
        },
        *message);
}

}  // namespace

Follower::Follower(ServerPlace place, std::string name, milliseconds patience)
    : m_place(std::move(place)), m_name(std::move(name)), m_patience(patience), m_pause(first_pause) {}

Result<Follower> Follower::connect(ServerPlace place, std::string name, milliseconds patience) {
    Follower follower(std::move(place), std::move(name), patience);
    WEAVE_CHECK_OK(follower.connect_once());
    return follower;
}

Error Follower::breach(const std::string& what) const {
    return bad_input("the server does not keep to the protocol: " + what, m_place.name);
}

// ---- Connections ----

Status Follower::connect_once() {
    auto client = Client::connect(m_place, m_name);
    if (!client) return std::move(client).error();
    m_client = std::move(*client);
    ++m_connections;
    m_heard = false;
    m_connected = Clock::now();
    WEAVE_CHECK_OK(take_up());
    note_trouble({});
    return {};
}

void Follower::note_trouble(std::optional<Error> trouble) {
    const bool changed = trouble.has_value() != m_trouble.has_value();
    m_trouble = std::move(trouble);
    if (changed && m_on_trouble) m_on_trouble(m_trouble ? &*m_trouble : nullptr);
}

/// Attaches to the session that is followed, where the last connection left it.
Status Follower::take_up() {
    if (!m_followed || m_followed->settled) return {};
    const milliseconds patience = m_place.options.answer_time;
    auto answer = m_client->ask(Attach{new_request_id(), m_followed->session, m_followed->seq, m_followed->frame}, patience);
    if (!answer) return std::move(answer).error();
    auto accepted = answer_of<Accepted>(std::move(*answer));
    if (!accepted && m_followed->ended) {  // the server knew already that its end was dealt with
        m_followed->settled = true;
        return {};
    }
    if (!accepted) return std::move(accepted).error().in(m_place.name);
    m_followed->acknowledged = 0;
    m_followed->whole = false;
    if (!m_followed->most_per_second) return {};
    return answer_of<Accepted>(m_client->ask(WantFrames{new_request_id(), m_followed->session, *m_followed->most_per_second}, patience))
               ? Status()
               : Status(breach("frames are refused that it sent before"));
}

/// The connection is no more. An error ends it all.
Status Follower::lost(Error error) {
    const auto now = Clock::now();
    const bool was_of_use = m_client && (m_heard || now - m_connected >= longest_pause);
    m_client.reset();
    if (error.code != ErrorCode::system) return *(m_over = std::move(error));
    if (was_of_use || !m_since) {
        m_since = now;
        m_pause = first_pause;
    }
    if (now - *m_since >= m_patience) {
        m_trouble = error;
        return *(m_over = std::move(error));
    }
    note_trouble(std::move(error));
    m_next_try = now + jittered(m_pause);
    m_pause = std::min(2 * m_pause, longest_pause);
    return {};
}

/// Tries to connect once it is time to, if that is before `end`.
Status Follower::reconnect(Clock::time_point end) {
    std::this_thread::sleep_until(std::min(m_next_try, end));
    if (Clock::now() < m_next_try) return {};
    if (Status status = connect_once(); !status) return lost(std::move(status).error());
    return {};
}

/// Takes the next message, or sees to it that there is a connection.
Status Follower::pump(Clock::time_point end, const std::string& id, std::optional<ServerMessage>& answer) {
    if (m_over) return *m_over;
    if (!m_client) return reconnect(end);
    auto received = m_client->receive(until(end));
    if (!received) return lost(std::move(received).error());
    if (!*received) return {};
    auto* message = std::get_if<ServerMessage>(&**received);
    if (message != nullptr && !id.empty() && answered_id(*message) == id) {
        m_heard = true;
        answer = std::move(*message);
        return {};
    }
    if (Status taken = take(std::move(**received)); !taken) return lost(std::move(taken).error());
    return {};
}

Status Follower::tell(const ClientMessage& message) {
    if (!m_client) return {};
    Status sent = m_client->send(message);
    if (sent || sent.error().code == ErrorCode::usage) return sent;
    return lost(std::move(sent).error());
}

void Follower::close() {
    if (m_client) m_client->close();
    m_client.reset();
}

// ---- Questions ----

Error Follower::no_answer() const {
    return m_client || !m_trouble ? system_fault("the server does not answer in time", m_place.name) : *m_trouble;
}

Result<ServerMessage> Follower::ask(const ClientMessage& message, milliseconds patience) {
    const bool is_for_others = std::holds_alternative<Create>(message) || std::holds_alternative<Attach>(message);
    if (is_for_others || request_id(message).empty()) return Error{ErrorCode::usage, "this message is not asked", {}};
    int times = 0;
    return ask(message, patience, times);
}

Result<ServerMessage> Follower::ask(const ClientMessage& message, milliseconds patience, int& times) {
    const std::string id = request_id(message);
    const auto end = Clock::now() + patience;
    std::uint64_t sent_on = 0;
    std::optional<ServerMessage> answer;
    while (!answer) {
        if (m_client && sent_on != m_connections) {
            sent_on = m_connections;
            ++times;
            WEAVE_CHECK_OK(tell(message));
        }
        WEAVE_CHECK_OK(pump(end, id, answer));
        if (!answer && Clock::now() >= end) return no_answer();
    }
    note_frames(message, *answer);
    return std::move(*answer);
}

void Follower::note_frames(const ClientMessage& message, const ServerMessage& answer) {
    const auto* want = std::get_if<WantFrames>(&message);
    if (want != nullptr && m_followed && std::holds_alternative<Accepted>(answer)) m_followed->most_per_second = want->most_per_second;
}

/// A connection serves one session, and so does a follower.
Status Follower::make_room() {
    if (m_followed && !m_followed->settled) return Error{ErrorCode::usage, "a session is followed already", {}};
    if (m_followed) m_client.reset();
    m_followed.reset();
    return {};
}

Result<Accepted> Follower::create(std::string document, const Simulation& simulation, milliseconds patience) {
    WEAVE_CHECK_OK(make_room());
    int times = 0;
    auto accepted = answer_of<Accepted>(ask(Create{new_request_id(), std::move(document), simulation}, patience, times));
    if (!accepted) return accepted;
    if (!accepted->session) return breach("a new session has no number");
    m_followed = Followed{.session = *accepted->session, .whole = true};
    if (times > 1) {  // an answer that was only given again attaches nobody
        m_client.reset();
        m_next_try = Clock::now();
    }
    return accepted;
}

Status Follower::attach(std::uint64_t session, std::uint64_t seq, std::uint64_t frame, milliseconds patience) {
    WEAVE_CHECK_OK(make_room());
    const auto end = Clock::now() + patience;
    while (!m_followed) {
        if (m_over) return *m_over;
        if (!m_client) {
            WEAVE_CHECK_OK(reconnect(end));
        } else {
            m_followed = Followed{.session = session, .seq = seq, .frame = frame, .given = seq, .acknowledged = seq};
            Status taken = take_up();
            if (taken) return {};
            m_followed.reset();
            if (taken.error().code != ErrorCode::system) return taken;
            WEAVE_CHECK_OK(lost(std::move(taken).error()));
        }
        if (!m_followed && Clock::now() >= end) return no_answer();
    }
    return {};
}

// ---- What comes ----

Result<std::optional<Received>> Follower::receive(milliseconds patience) {
    const auto end = Clock::now() + patience;
    const bool behind = m_followed && m_followed->given - m_followed->acknowledged >= most_unacknowledged;
    if (m_waiting.empty() || behind) {
        WEAVE_CHECK_OK(acknowledge());
    }
    std::optional<ServerMessage> none;
    do {
        if (m_waiting.empty()) {
            WEAVE_CHECK_OK(pump(end, "", none));
        }
        if (m_waiting.empty()) continue;
        std::optional<Received> next = std::move(m_waiting.front());
        m_waiting.pop_front();
        if (const std::uint64_t seq = seq_of(*next); m_followed && seq > 0) m_followed->given = seq;
        return next;
    } while (Clock::now() < end);
    return std::optional<Received>();
}

Status Follower::acknowledge() {
    if (!m_client || !m_followed || m_followed->settled || m_followed->given == m_followed->acknowledged) return {};
    const std::uint64_t given = m_followed->given, connection = m_connections;
    WEAVE_CHECK_OK(tell(Acknowledge{m_followed->session, given}));
    if (!m_client || connection != m_connections) return {};  // once there is another
    m_followed->acknowledged = given;
    m_followed->settled = m_followed->ended && given == m_followed->seq;
    return {};
}

Status Follower::acknowledge_job(std::uint64_t job, milliseconds patience) {
    m_settled_jobs.insert(job);
    const auto end = Clock::now() + patience;
    std::uint64_t told_on = 0;
    do {
        told_on = m_client ? m_connections : 0;
        WEAVE_CHECK_OK(tell(AcknowledgeJob{job}));
        // An answer to what is sent behind it, on the same connection, comes after it was read.
        const auto known = answer_of<JobList>(ask(ListJobs{new_request_id()}, until(end)));
        if (!known) return known.error();
    } while (told_on != m_connections);
    return {};
}

Status Follower::take(Received received) {
    if (auto* frame = std::get_if<Frame>(&received)) return take_frame(std::move(*frame));
    auto& message = std::get<ServerMessage>(received);
    return std::visit(
        [&](auto& told) -> Status {
            using M = std::decay_t<decltype(told)>;
            if constexpr (is_event<M>) {
                const std::uint64_t session = told.session, seq = told.seq;
                return take_event(session, seq, std::move(message));
            }
            if constexpr (std::same_as<M, JobEnded>) return take_job_end(std::move(told));
            if constexpr (std::same_as<M, JobProgress>) return take_progress(std::move(told));
            if constexpr (std::same_as<M, Gap>) return queue(std::move(message));
            if constexpr (std::same_as<M, Welcome> || std::same_as<M, Unsupported>) return breach("it greets twice");
            if constexpr (std::same_as<M, Refused>) {
                if (!told.request) return bad_input("the server could not read a message: " + told.error.text(), m_place.name);
            }
            return {};  // an answer that nobody waits for any more
        },
        message);
}

Status Follower::take_event(std::uint64_t session, std::uint64_t seq, ServerMessage message) {
    if (!m_followed || session != m_followed->session) return breach("it tells of a session that was not asked for");
    const std::uint64_t last = m_followed->seq;
    if (seq <= last || m_followed->ended || (m_followed->whole && seq != last + 1))
        return breach("event " + std::to_string(seq) + " comes after event " + std::to_string(last));
    m_followed->seq = seq;
    m_followed->ended = std::holds_alternative<Ended>(message);
    m_heard = true;
    return queue(std::move(message));
}

Status Follower::take_frame(Frame frame) {
    if (!m_followed || frame.head.session != m_followed->session || frame.head.number <= m_followed->frame) return {};
    m_followed->frame = frame.head.number;
    m_heard = true;
    std::erase_if(m_waiting, [](const Received& waiting) { return std::holds_alternative<Frame>(waiting); });
    return queue(std::move(frame));
}

Status Follower::take_job_end(JobEnded ended) {
    if (m_settled_jobs.contains(ended.job)) return tell(AcknowledgeJob{ended.job});
    if (!m_told_jobs.insert(ended.job).second) return {};
    m_heard = true;
    return queue(ServerMessage(std::move(ended)));
}

Status Follower::take_progress(JobProgress progress) {
    m_heard = true;
    std::erase_if(m_waiting, [&](const Received& waiting) {
        const auto* message = std::get_if<ServerMessage>(&waiting);
        const auto* before = message != nullptr ? std::get_if<JobProgress>(message) : nullptr;
        return before != nullptr && before->state.job == progress.state.job;
    });
    return queue(ServerMessage(std::move(progress)));
}

Status Follower::queue(Received received) {
    if (m_waiting.size() == most_waiting) return breach("it sends all kinds of things, but no answer");
    m_waiting.push_back(std::move(received));
    return {};
}

Result<std::string> Follower::download(const std::string& target, std::uint64_t most) {
    const auto end = Clock::now() + m_patience;
    for (milliseconds pause = first_pause;; pause = std::min(2 * pause, longest_pause)) {
        auto bytes = wire::download(m_place, target, most);
        if (bytes || bytes.error().code != ErrorCode::system || Clock::now() + pause >= end) return bytes;
        std::this_thread::sleep_for(jittered(pause));
    }
}

}  // namespace weave::wire
