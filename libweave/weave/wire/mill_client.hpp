#pragma once

#include <weave/core/json.hpp>
#include <weave/net/websocket_client.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <weave/wire/mill_session.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace weave::wire {

/// Where the API of loomlink begins.
inline constexpr const char* mill_api_root = "/api/v1";

/// `/designs/my%20cloth/revisions/3` of its segments, each encoded.
std::string mill_path(std::initializer_list<std::string> segments);

/// Speaks the API of loomlink (loomlink/service/API.md) as the person of a session. For one thread at a time. What
/// the server refuses is an Error of the kind that it says; a refusal names the path that was asked for.
class MillClient {
  public:
    /// Errors as of client_options().
    static Result<MillClient> of(MillSession session);

    /// Asks for JSON; numbers and texts of the query come as they are.
    Result<Json> get(const std::string& path, const net::Parameters& query = {});
    /// Asks for bytes, such as a file. Error (bad_input): more than `most`.
    Result<std::string> get_bytes(const std::string& path, const net::Parameters& query, std::size_t most);
    Result<std::string> get_bytes(const std::string& path, std::size_t most) {
        return get_bytes(path, {}, most);
    }
    /// Changes something, under a request id of its own. Where the connection breaks or the server is busy it
    /// is asked again under the same id, so that it is done once. Passwords in `body` are wiped.
    Result<Json> change(const std::string& method, const std::string& path, Json body = Json::object());
    Result<Json> post(const std::string& path, Json body = Json::object()) {
        return change("POST", path, std::move(body));
    }
    /// A WebSocket.
    [[nodiscard]] Result<net::WebSocketClient> watch(const std::string& path) const;

    [[nodiscard]] const MillSession& session() const { return m_session; }
    /// Whether the last call was refused because nobody is signed in, or no longer.
    [[nodiscard]] bool is_signed_out() const { return m_signed_out; }
    /// Is told how much of a request's body is sent, of how much, at least ten times a second while one is under way; false gives it
    /// up (Error: refused).
    using Progress = std::function<bool(std::size_t sent, std::size_t of)>;
    void report_to(Progress progress) { m_progress = std::move(progress); }
    /// From now on as this session says, of the same server.
    void continue_as(MillSession session) { m_session = std::move(session); }

  private:
    MillClient(MillSession session, net::ClientOptions options);
    [[nodiscard]] net::Headers headers() const;
    Result<net::Response> send(net::ClientRequest& request, const net::Sink* sink = nullptr);
    bool waits(std::chrono::milliseconds time) const;

    MillSession m_session;
    net::ClientOptions m_options;
    net::HttpClient m_http;
    Progress m_progress;
    bool m_signed_out = false;
};

/// Members of an answer that a command cannot do without. Error (bad_input): the answer lacks it.
Result<std::string> text_member(const Json& answer, const std::string& member);
Result<std::int64_t> number_member(const Json& answer, const std::string& member);
Result<std::vector<std::string>> texts_member(const Json& answer, const std::string& member);

}  // namespace weave::wire
