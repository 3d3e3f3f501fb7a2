#pragma once

#include <weave/core/json.hpp>
#include <weave/net/websocket_client.hpp>

#include <cstddef>
#include <initializer_list>
#include <loomlink/commands/session.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace weave::loomlink {

/// `/designs/my%20cloth/revisions/3` of its segments, each encoded.
std::string api_path(std::initializer_list<std::string> segments);

/// Speaks the API of loomlink (service/API.md) as the person of a session. For one thread at a time. What
/// the server refuses is an Error of the kind that it says; a refusal names the path that was asked for.
class ApiClient {
  public:
    /// Errors as of client_options().
    static Result<ApiClient> of(KeptSession session);

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

    [[nodiscard]] const KeptSession& session() const { return m_session; }
    /// Whether the last call was refused because nobody is signed in, or no longer.
    [[nodiscard]] bool is_signed_out() const { return m_signed_out; }
    /// From now on as this session says, of the same server.
    void continue_as(KeptSession session) { m_session = std::move(session); }

  private:
    ApiClient(KeptSession session, net::ClientOptions options);
    [[nodiscard]] net::Headers headers() const;
    Result<net::Response> send(const net::ClientRequest& request, const net::Sink* sink = nullptr);

    KeptSession m_session;
    net::ClientOptions m_options;
    net::HttpClient m_http;
    bool m_signed_out = false;
};

/// Members of an answer that a command cannot do without. Error (bad_input): the answer lacks it.
Result<std::string> text_member(const Json& answer, const std::string& member);
Result<std::int64_t> number_member(const Json& answer, const std::string& member);
Result<std::vector<std::string>> texts_member(const Json& answer, const std::string& member);

}  // namespace weave::loomlink
