#include <simd/service/routes.hpp>

#include <weave/core/file.hpp>
#include <weave/core/text.hpp>
#include <weave/net/health.hpp>
#include <weave/wire/message.hpp>

#include <algorithm>
#include <functional>
#include <map>
#include <mutex>
#include <simd/service/connection.hpp>
#include <simd/service/page.hpp>
#include <utility>

namespace weave::simd {

namespace {

using net::Request;
using net::Response;

/// No file that is handed out is larger; it is in memory once.
constexpr std::uint64_t most_file = std::uint64_t{8} << 30;

Response unknown_visitor(const Error& error) {
    Response response = net::error_answer(error, 401);
    response.headers.set("WWW-Authenticate", "Bearer");
    return response;
}

/// An answer that only visitors get.
net::Handler for_visitors(Doorkeeper& doorkeeper, std::function<Response(const Visitor&, const Request&)> answer) {
    return [&doorkeeper, answer = std::move(answer)](const Request& request) {
        const auto visitor = doorkeeper.let_in(request);
        return visitor ? answer(*visitor, request) : unknown_visitor(visitor.error());
    };
}

std::uint64_t number_in(const Request& request, const char* place) {
    const auto number = parse_whole(request.place(place));
    return number && *number > 0 ? static_cast<std::uint64_t>(*number) : 0;
}

Response not_there(const Error& error) {
    return net::error_answer(error, error.code == ErrorCode::refused ? 404 : net::status_of(error.code));
}

Response file_answer(const std::filesystem::path& path) {
    auto bytes = read_file(path, most_file);
    if (!bytes) return net::error_answer(system_fault(bytes.error().text()));
    return net::answer(200, "application/octet-stream", net::make_bytes(std::move(*bytes)));
}

/// Bounds how many threads that answer wait for sessions to write files, so that there are always some for everybody else.
class WaitingRoom {
  public:
    explicit WaitingRoom(std::size_t workers) : m_most(std::max<std::size_t>(1, workers / 2)), m_most_of_one(std::max<std::size_t>(1, workers / 4)) {}

    /// A seat, as long as it lives; null where there is none.
    std::shared_ptr<void> seat(const std::string& person) {
        const std::lock_guard lock(m_mutex);
        if (m_taken == m_most || m_taken_by[person] == m_most_of_one) return nullptr;
        ++m_taken;
        ++m_taken_by[person];
        return {this, [person](WaitingRoom* room) { room->leave(person); }};
    }

  private:
    void leave(const std::string& person) {
        const std::lock_guard lock(m_mutex);
        --m_taken;
        if (--m_taken_by[person] == 0) m_taken_by.erase(person);
    }

    const std::size_t m_most, m_most_of_one;
    std::mutex m_mutex;
    std::size_t m_taken = 0;
    std::map<std::string, std::size_t> m_taken_by;
};

Response come_again(const Error& why, std::chrono::seconds wait) {
    Response response = net::error_answer(why, 503);
    response.headers.set("Retry-After", std::to_string(wait.count()));
    return response;
}

Response session_yarns(Daemon& daemon, WaitingRoom& waiting, const Visitor& visitor, const Request& request) {
    const auto seat = waiting.seat(visitor.person);
    if (!seat) return come_again({ErrorCode::refused, "too many wait for files of sessions: try again", "yarns"}, std::chrono::seconds(1));
    const auto path = daemon.session_yarns(visitor.person, number_in(request, "session"));
    if (!path) return not_there(path.error());
    Response response = file_answer(*path);
    std::error_code ignored;
    std::filesystem::remove(*path, ignored);
    return response;
}

Response job_yarns(Daemon& daemon, const Visitor& visitor, const Request& request) {
    const auto path = daemon.job_yarns(visitor.person, number_in(request, "job"));
    return path ? file_answer(*path) : not_there(path.error());
}

Response job_evidence(Daemon& daemon, const Visitor& visitor, const Request& request) {
    auto document = daemon.job_evidence(visitor.person, number_in(request, "job"));
    return document ? net::answer(200, "application/json", net::make_bytes(std::move(*document))) : not_there(document.error());
}

net::WebSocketAdmission open_wire(const ServiceParts& parts, const Request& request) {
    auto visitor = parts.doorkeeper.let_in(request);
    if (!visitor) return unknown_visitor(visitor.error());
    if (const auto wait = parts.doorkeeper.wait(visitor->person); wait.count() > 0)
        return come_again({ErrorCode::refused, "your connections were closed for asking too much: wait a little", "wire"}, wait);
    return std::make_unique<Connection>(parts.daemon, parts.doorkeeper, std::move(*visitor), "simd " + parts.version);
}

}  // namespace

Result<net::Router> service_routes(const ServiceParts& parts) {
    net::Router router;
    Daemon& daemon = parts.daemon;
    const auto get = [&](const char* name, const char* pattern, const char* description, net::Handler handler) {
        return router.add({name, "GET", pattern, description, 0, std::move(handler), {}});
    };
    WEAVE_CHECK_OK(router.add({"wire", "GET", "/api/v1/wire", "The protocol, over a WebSocket.", wire::most_client_bytes, {},
                               [parts](const Request& request) { return open_wire(parts, request); }}));
    WEAVE_CHECK_OK(get("session.yarns", "/api/v1/sessions/{session}/yarns", "The yarns of a session as they lie.",
                       for_visitors(parts.doorkeeper, [&daemon, waiting = std::make_shared<WaitingRoom>(parts.workers)](const Visitor& visitor, const Request& request) {
                           return session_yarns(daemon, *waiting, visitor, request);
                       })));
    WEAVE_CHECK_OK(get("job.yarns", "/api/v1/jobs/{job}/yarns", "The yarns of a job that has ended.",
                       for_visitors(parts.doorkeeper, [&daemon](const Visitor& visitor, const Request& request) { return job_yarns(daemon, visitor, request); })));
    WEAVE_CHECK_OK(get("job.evidence", "/api/v1/jobs/{job}/evidence", "The signed evidence of a job that is done.",
                       for_visitors(parts.doorkeeper, [&daemon](const Visitor& visitor, const Request& request) { return job_evidence(daemon, visitor, request); })));
    WEAVE_CHECK_OK(get("status", "/api/v1/status", "Sessions, jobs, memory and pace.",
                       for_visitors(parts.doorkeeper, [&daemon](const Visitor& visitor, const Request&) {
                           return net::json_answer(200, daemon.status(visitor.is_local));
                       })));
    WEAVE_CHECK_OK(get("health", "/healthz", "Whether it does its work.", [checks = daemon.health()](const Request&) { return net::health_answer(checks); }));
    WEAVE_CHECK_OK(get("metrics", "/metrics", "Numbers for Prometheus.", [metrics = parts.metrics](const Request&) {
        return net::answer(200, "text/plain; version=0.0.4; charset=utf-8", net::make_bytes(metrics->text()));
    }));
    WEAVE_CHECK_OK(get("page", "/", "What the machine does, for people.", [&daemon, version = parts.version](const Request&) {
        Response page = net::answer(200, "text/html; charset=utf-8", net::make_bytes(status_page(daemon.status(false), version)));
        page.headers.set("Content-Security-Policy", "default-src 'none'; style-src 'unsafe-inline'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'");
        return page;
    }));
    return router;
}

}  // namespace weave::simd
