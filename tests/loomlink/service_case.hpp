#pragma once

#include <weave/core/json.hpp>
#include <weave/net/client.hpp>
#include <weave/net/server.hpp>

#include <catch2/catch.hpp>

#include <atomic>
#include <loomlink/service/service.hpp>
#include <loomlink/service/watchers.hpp>
#include <loomlink/workflow/denial.hpp>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace weave::loomlink::testing {

/// Fills the places of a path: `{n}` with 1, all others with `x`.
inline std::string filled(std::string path) {
    for (std::size_t open = path.find('{'); open != std::string::npos; open = path.find('{')) {
        const std::size_t close = path.find('}', open);
        path.replace(open, close - open + 1, path.compare(open, 3, "{n}") == 0 ? "1" : "x");
    }
    return path;
}

/// The least that a schema of the API document lets pass.
inline Json sample_of(const Json& schema) {
    if (schema.contains("enum")) return schema["enum"][0];
    const Json type = schema.at("type").is_array() ? schema["type"][0] : schema["type"];
    if (type == "object") {
        Json object = Json::object();
        for (const auto& name : schema.at("required"))
            object[name.get<std::string>()] = sample_of(schema["properties"].at(name.get<std::string>()));
        return object;
    }
    if (type == "array") {
        Json list = Json::array();
        for (std::size_t k = 0; k < schema.value("minItems", std::size_t{0}); ++k)
            list.push_back(sample_of(schema["items"]));
        return list;
    }
    if (type == "string")  // what has a length that says something is as long as it may be
        return std::string(
            schema.value("maxLength", std::size_t{64}) <= 64 ? schema.value("maxLength", std::size_t{64}) : 8,
            'a');
    return schema.value("minimum", 1);
}

/// What the gate tells of somebody whom it sends away.
struct ToldRefusal {
    std::string login, request;
    Deed attempt;
    Error error;
};

/// A service whose handlers all answer `{"route": NAME}` and count, with the sessions that a test wants.
struct StubService {
    std::map<std::string, SignedIn> sessions;
    std::atomic<int> reached{0};
    Watchers watchers;
    std::atomic<bool> may_watch{true};
    std::optional<net::Server> server;

    explicit StubService(const net::ThrottleRate& strangers = {1e9, 1e9, 10000}) : m_strangers(strangers) {}

    void start() {
        ServiceParts parts;
        for (const ApiRoute& line : api_table()) {
            if (line.is_socket)
                parts.handlers.sockets[line.name] = [this](const ApiCall& call) -> net::WebSocketAdmission {
                    return watchers.watch(call.place("loom"), [this] { return may_watch.load(); });
                };
            else
                parts.handlers.answers[line.name] = [this, name = line.name](const ApiCall&) {
                    ++reached;
                    return net::json_answer(200, {{"route", name}});
                };
        }
        parts.session = [this](const std::string& token) -> Result<SignedIn> {
            const auto found = sessions.find(token);
            if (found == sessions.end()) return deny(Denial::who, "sign in first");
            return found->second;
        };
        parts.refused = [this](const Caller& caller, const std::string& request, const Deed& attempt,
                               const Error& error) {
            const std::lock_guard lock(m_mutex);
            m_refusals.push_back({caller.login, request, attempt, error});
        };
        parts.metrics = std::make_shared<net::Metrics>();
        parts.health = {{"store", [] { return Status(); }}};
        parts.version = "test";
        parts.strangers = m_strangers;
        auto routes = service_routes(parts);
        REQUIRE(routes);
        net::ServerOptions options;
        options.metrics = parts.metrics;
        auto started = net::Server::start(*std::move(routes), options);
        REQUIRE(started);
        server.emplace(*std::move(started));
    }

    [[nodiscard]] net::ClientOptions client_options() const {
        net::ClientOptions options;
        options.port = server->port();
        return options;
    }

    /// What the gate told of, oldest first; it is forgotten.
    std::vector<ToldRefusal> take_refusals() {
        const std::lock_guard lock(m_mutex);
        return std::exchange(m_refusals, {});
    }

  private:
    net::ThrottleRate m_strangers;
    std::mutex m_mutex;
    std::vector<ToldRefusal> m_refusals;
};

/// Asks, and fails the test where nothing comes.
inline net::Response ask(net::HttpClient& client, const std::string& method, const std::string& target,
                         const net::Headers& headers = {}, const std::string& body = {}) {
    net::ClientRequest request{method, target, headers, body};
    auto answer = client.send(request);
    if (!answer) FAIL(method << " " << target << ": " << answer.error().text());
    return *std::move(answer);
}

/// The same members in the order of their names.
inline Json sorted(const Json& json) {
    return parse_json(canonical_json(json)).value();
}

inline Json json_of(const net::Response& response) {
    return parse_json(response.body ? *response.body : "").value();
}

}  // namespace weave::loomlink::testing
