#pragma once

#include <weave/core/sha256.hpp>
#include <weave/net/server.hpp>
#include <weave/wire/client.hpp>

#include <catch2/catch.hpp>

#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace weave::testing {

/// What a job comes to.
struct JobResult {
    std::optional<Error> error;
    Json report = Json::object();
    std::string yarns;                    ///< bytes of the file
    std::optional<std::string> evidence;  ///< bytes of the document
};

/// What happens in place of a message that the server would send.
struct Mishap {
    std::optional<std::uint16_t> close;  ///< the connection ends with this code …
    std::string text, binary;            ///< … or these bytes are sent; with none of the three, nothing
};

/// A simd that keeps to the protocol and does what its test wrote down: sessions are over before anybody attaches to
/// them, and jobs come to what a function makes of them. Messages to clients are counted from 0 over all connections,
/// and a mishap can take the place of any. It remembers what an honest server keeps on disk, so it can be restarted.
class ScriptedSimd {
  public:
    using Work = std::function<JobResult(const wire::Submit&)>;

    ScriptedSimd() { start(0); }
    ~ScriptedSimd() { stop(); }
    ScriptedSimd(const ScriptedSimd&) = delete;
    ScriptedSimd& operator=(const ScriptedSimd&) = delete;

    /// What the test writes down.
    struct Script {
        std::string token;                    ///< that every client must have; empty: none is asked for
        std::vector<wire::Received> session;  ///< events and frames of every session, numbered from 1
        Work work;                            ///< of every job
        bool holds_jobs = false;              ///< jobs run on until they are cancelled, or let_go() is called
        bool holds_queue = false;             ///< jobs wait likewise
        bool signs = true;                    ///< says that it has a key to sign with
        std::map<std::size_t, Mishap> mishaps;
        std::size_t break_every = 0;          ///< every so many messages the connection ends with break_code instead
        std::uint16_t break_code = 1001;
    };
    /// No client is heard while it is written: `simd.script()->signs = false`.
    class Written {
      public:
        Written(std::mutex& mutex, Script& script) : m_lock(mutex), m_script(script) {}
        Script* operator->() { return &m_script; }

      private:
        std::unique_lock<std::mutex> m_lock;
        Script& m_script;
    };
    [[nodiscard]] Written script() { return {m_mutex, m_script}; }

    // ---- What it saw ----

    [[nodiscard]] std::string origin() const { return "http://127.0.0.1:" + std::to_string(m_port); }
    [[nodiscard]] wire::ServerPlace place() const {
        auto place = wire::place_of(origin());
        REQUIRE(place);
        const std::lock_guard lock(m_mutex);
        if (!m_script.token.empty()) REQUIRE(wire::use_token(*place, m_script.token));
        return *place;
    }
    template <class Read>
    auto look(Read read) {
        const std::lock_guard lock(m_mutex);
        return read(*this);
    }
    std::size_t sent = 0, connections = 0;
    std::vector<wire::ClientMessage> heard;
    std::map<std::uint64_t, std::uint64_t> acknowledged;  ///< of each session the last event
    std::set<std::uint64_t> acknowledged_jobs;
    bool repeated_attach = false;  ///< what concerns one connection alone came again under its id

    template <class M>
    [[nodiscard]] std::size_t count_of() const {
        std::size_t count = 0;
        for (const auto& message : heard) count += std::holds_alternative<M>(message) ? 1 : 0;
        return count;
    }

    /// Ends all connections without a goodbye of its own and starts again at the same port.
    void restart() {
        stop();
        start(m_port);
    }
    void stop() {
        if (m_server) m_server->stop(std::chrono::milliseconds(0));
        m_server.reset();
    }
    /// Forgets all jobs, as no honest server does.
    void lose_jobs() {
        const std::lock_guard lock(m_mutex);
        m_jobs.clear();
    }
    /// Lets held jobs run to their end.
    void let_go() {
        const std::lock_guard lock(m_mutex);
        m_script.holds_jobs = m_script.holds_queue = false;
        for (auto& [number, job] : m_jobs)
            if (!job.end) finish(number, job);
    }

  private:
    struct Job {
        wire::Submit submit;
        std::optional<wire::JobEnded> end;
        JobResult result;
    };
    struct Line {
        std::shared_ptr<net::WebSocket> socket;
        bool greeted = false, broken = false;
    };
    class Ear : public net::WebSocketHandler {
      public:
        explicit Ear(ScriptedSimd& simd) : m_simd(simd), m_line(std::make_shared<Line>()) {}
        void opened(std::shared_ptr<net::WebSocket> socket) override {
            const std::lock_guard lock(m_simd.m_mutex);
            m_line->socket = std::move(socket);
            m_simd.m_lines.push_back(m_line);
            ++m_simd.connections;
        }
        void message(net::WebSocketMessage message) override {
            const std::lock_guard lock(m_simd.m_mutex);
            if (auto read = wire::read_client_message(message.bytes)) m_simd.hear(*m_line, std::move(*read));
            else m_line->socket->close(1008, "unreadable");
        }
        void closed(const net::WebSocketEnd&) override {
            const std::lock_guard lock(m_simd.m_mutex);
            m_line->broken = true;
        }

      private:
        ScriptedSimd& m_simd;
        std::shared_ptr<Line> m_line;
    };

    void start(std::uint16_t port) {
        net::Router router;
        const auto admit = [this](const net::Request& request) -> net::WebSocketAdmission {
            if (!is_known(request)) return net::error_answer({ErrorCode::refused, "no valid token", {}}, 401);
            return std::make_unique<Ear>(*this);
        };
        REQUIRE(router.add({"wire", "GET", "/api/v1/wire", "Messages", wire::most_client_bytes, {}, admit}));
        const auto add = [&](const std::string& name, const std::string& pattern, auto answer) {
            const auto handle = [this, answer](const net::Request& request) {
                if (!is_known(request)) return net::error_answer({ErrorCode::refused, "no valid token", {}}, 401);
                const std::lock_guard lock(m_mutex);
                return answer(request);
            };
            REQUIRE(router.add({name, "GET", pattern, "A file", 0, handle, {}}));
        };
        add("yarns", "/api/v1/jobs/{job}/yarns", [this](const net::Request& request) { return yarns_of(request); });
        add("evidence", "/api/v1/jobs/{job}/evidence", [this](const net::Request& request) { return evidence_of(request); });
        net::ServerOptions options;
        options.port = port;
        options.limits.control_bytes = 2 * wire::most_frame_bytes;  // mishaps may be longer than is allowed
        auto server = net::Server::start(std::move(router), options);
        REQUIRE(server);
        m_server.emplace(std::move(*server));
        m_port = m_server->port();
    }

    [[nodiscard]] bool is_known(const net::Request& request) const {
        const std::lock_guard lock(m_mutex);
        return m_script.token.empty() || request.headers.get("Authorization") == "Bearer " + m_script.token;
    }
    const Job* job_of(const net::Request& request) const {
        const auto found = m_jobs.find(std::stoull(request.place("job")));
        return found == m_jobs.end() || acknowledged_jobs.contains(found->first) ? nullptr : &found->second;
    }
    net::Response yarns_of(const net::Request& request) const {
        const Job* job = job_of(request);
        if (job == nullptr || job->result.yarns.empty()) return net::error_answer({ErrorCode::refused, "there is no such file", {}}, 404);
        return net::answer(200, "application/octet-stream", net::make_bytes(job->result.yarns));
    }
    net::Response evidence_of(const net::Request& request) const {
        const Job* job = job_of(request);
        if (job == nullptr || !job->result.evidence) return net::error_answer({ErrorCode::refused, "there is no such file", {}}, 404);
        return net::answer(200, "application/json", net::make_bytes(*job->result.evidence));
    }

    // ---- Sending ----

    void say(Line& line, const wire::ServerMessage& message) { put(line, wire::write_message(message), false); }
    void put(Line& line, std::string bytes, bool binary) {
        if (line.broken) return;
        const std::size_t number = sent++;
        Mishap mishap;
        const auto found = m_script.mishaps.find(number);
        if (found != m_script.mishaps.end()) mishap = found->second;
        const bool breaks = m_script.break_every > 0 && number % m_script.break_every == m_script.break_every - 1;
        if (breaks) mishap.close = m_script.break_code;
        if (found == m_script.mishaps.end() && !breaks) {
            line.socket->send_control(net::make_bytes(std::move(bytes)), binary);
            return;
        }
        if (mishap.close) {
            line.broken = true;
            line.socket->close(*mishap.close, "");
        }
        if (!mishap.text.empty()) line.socket->send_control(net::make_bytes(mishap.text), false);
        if (!mishap.binary.empty()) line.socket->send_control(net::make_bytes(mishap.binary), true);
    }
    void answer(Line& line, const std::string& request, wire::ServerMessage message) {
        m_answers[request] = message;
        say(line, message);
    }

    // ---- Hearing ----

    void hear(Line& line, wire::ClientMessage message) {
        heard.push_back(message);
        const std::string id = wire::request_id(message);
        const bool of_connection = std::holds_alternative<wire::Attach>(message) || std::holds_alternative<wire::WantFrames>(message);
        if (const auto known = m_answers.find(id); !id.empty() && known != m_answers.end()) {
            repeated_attach = repeated_attach || of_connection;
            return say(line, known->second);
        }
        std::visit([&](const auto& asked) { hear_one(line, asked); }, message);
    }
    template <class M>
    void hear_one(Line& line, const M& message) {
        if constexpr (requires { message.request; }) answer(line, message.request, wire::Accepted{message.request, {}, {}, {}});
    }
    void hear_one(Line& line, const wire::Hello&) {
        say(line, wire::Welcome{1, "scripted", "dora"});
        line.greeted = true;
        for (const auto& [number, job] : m_jobs) {
            if (job.end && !acknowledged_jobs.contains(number)) say(line, *job.end);
            if (!job.end) say(line, wire::JobProgress{state_of(number, job)});
        }
    }
    void hear_one(Line& line, const wire::Create& create) {
        const std::uint64_t number = ++m_sessions;
        answer(line, create.request, wire::Accepted{create.request, number, {}, {}});
        show(line, number, 0, 0, true);
    }
    void hear_one(Line& line, const wire::Attach& attach) {
        if (attach.session == 0 || attach.session > m_sessions || m_forgotten.contains(attach.session))
            return say(line, wire::Refused{attach.request, {ErrorCode::usage, "there is no such session", {}}, {}});
        answer(line, attach.request, wire::Accepted{attach.request, {}, {}, {}});
        show(line, attach.session, attach.seq, attach.frame, false);
    }
    void hear_one(Line&, const wire::Acknowledge& known) {
        auto& last = acknowledged[known.session];
        last = std::max(last, known.seq);
        if (last >= events()) m_forgotten.insert(known.session);
    }
    void hear_one(Line& line, const wire::ListSessions& list) {
        wire::SessionList sessions{list.request, {}};
        for (std::uint64_t number = 1; number <= m_sessions; ++number) {
            if (m_forgotten.contains(number)) continue;
            const bool ended = number % 2 == 0;
            wire::SessionSummary one{number, "cloth", wire::Phase::at_rest, 20, 0.5, 136, number == 3 ? 2U : 0U, ended, ended ? 90000 : 3600};
            if (number == 3) one.left_s.reset();
            sessions.sessions.push_back(one);
        }
        answer(line, list.request, sessions);
    }
    void hear_one(Line& line, const wire::Submit& submit) {
        const std::uint64_t number = m_jobs.size() + 1;
        Job& job = m_jobs[number];
        job.submit = submit;
        answer(line, submit.request, wire::Accepted{submit.request, {}, number, m_script.holds_queue ? std::optional(240.0) : std::nullopt});
        tell_all(wire::JobProgress{state_of(number, job)});
        if (!m_script.holds_jobs && !m_script.holds_queue) finish(number, job);
    }
    void hear_one(Line& line, const wire::ListJobs& list) {
        wire::JobList jobs{list.request, {}, m_script.signs};
        for (const auto& [number, job] : m_jobs)
            if (!acknowledged_jobs.contains(number)) jobs.jobs.push_back(state_of(number, job));
        answer(line, list.request, jobs);
    }
    void hear_one(Line& line, const wire::Cancel& cancel) {
        const auto found = m_jobs.find(cancel.job);
        if (found == m_jobs.end())
            return answer(line, cancel.request, wire::Refused{cancel.request, {ErrorCode::usage, "there is no such job", {}}, {}});
        answer(line, cancel.request, wire::Accepted{cancel.request, {}, {}, {}});
        if (found->second.end) return;
        if (m_script.holds_queue) end_with(found->first, found->second, wire::JobEnded{found->first, wire::JobPhase::cancelled, {}, Json::object(), {}});
        else finish(found->first, found->second, wire::JobPhase::cancelled);
    }
    void hear_one(Line&, const wire::AcknowledgeJob& known) { acknowledged_jobs.insert(known.job); }

    // ---- Sessions and jobs ----

    std::uint64_t events() const {
        std::uint64_t count = 0;
        for (const wire::Received& item : m_script.session) count += std::holds_alternative<wire::ServerMessage>(item) ? 1 : 0;
        return count;
    }
    /// All of a session, or what one that was attached has not had of it: events, then the newest frame.
    void show(Line& line, std::uint64_t number, std::uint64_t seq, std::uint64_t frame, bool all) {
        std::uint64_t event = 0, shown = 0;
        std::optional<wire::Frame> newest;
        for (wire::Received item : m_script.session) {
            if (auto* picture = std::get_if<wire::Frame>(&item)) {
                picture->head.session = number;
                picture->head.number = ++shown;
                newest = *picture;
                if (all) put(line, wire::encode_frame(*picture).value(), true);
                continue;
            }
            if (++event <= seq) continue;
            auto& told = std::get<wire::ServerMessage>(item);
            std::visit([&](auto& one) { if constexpr (requires { one.seq; }) one.session = number, one.seq = event; }, told);
            say(line, told);
        }
        if (!all && newest && newest->head.number > frame) put(line, wire::encode_frame(*newest).value(), true);
    }
    wire::JobState state_of(std::uint64_t number, const Job& job) const {
        if (job.end) return {number, job.end->phase, "cloth", 20, {}, {}, {}, {}, {}, {}};
        if (m_script.holds_queue) return {number, wire::JobPhase::waiting, "cloth", 0, {}, {}, {}, 3, 240, {}};
        return {number, wire::JobPhase::running, "cloth", 20, 0.5, {}, 12, {}, {}, {}};
    }
    void finish(std::uint64_t number, Job& job, wire::JobPhase phase = wire::JobPhase::done) {
        job.result = m_script.work(job.submit);
        wire::JobEnded end{number, job.result.error ? wire::JobPhase::failed : phase, job.result.error, job.result.report, {}};
        if (phase == wire::JobPhase::cancelled) job.result.evidence.reset();
        if (job.result.evidence) end.evidence = parse_json(*job.result.evidence).value();
        end_with(number, job, std::move(end));
    }
    void end_with(std::uint64_t, Job& job, wire::JobEnded end) {
        job.end = std::move(end);
        tell_all(*job.end);
    }
    void tell_all(const wire::ServerMessage& message) {
        for (const auto& line : m_lines)
            if (line->greeted && !line->broken) say(*line, message);
    }

    mutable std::mutex m_mutex;
    Script m_script;
    std::vector<std::shared_ptr<Line>> m_lines;
    std::map<std::string, wire::ServerMessage> m_answers;
    std::map<std::uint64_t, Job> m_jobs;
    std::uint64_t m_sessions = 0;
    std::set<std::uint64_t> m_forgotten;
    std::uint16_t m_port = 0;
    std::optional<net::Server> m_server;
};

}  // namespace weave::testing
