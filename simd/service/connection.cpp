#include <simd/service/connection.hpp>

#include <weave/wire/client.hpp>

#include <algorithm>
#include <utility>
#include <variant>

namespace weave::simd {

namespace {

/// A connection may send so many messages that nobody can read.
constexpr std::size_t most_not_understood = 100;

}  // namespace

Connection::~Connection() {
    if (m_client) m_daemon.leave(m_client);
}

void Connection::opened(std::shared_ptr<net::WebSocket> socket) {
    m_client = std::make_shared<Client>(m_visitor.person, m_visitor.may_stay, std::move(socket));
    m_daemon.enter(m_client);
}

void Connection::message(net::WebSocketMessage message) {
    take(std::move(message));
    const bool is_out = m_client->is_thrown_out() && !std::exchange(m_is_out, m_client->is_thrown_out());
    if (is_out && !m_visitor.is_local) m_doorkeeper.thrown_out(m_visitor.person);
}

void Connection::take(net::WebSocketMessage message) {
    if (message.binary) return m_client->close(1003, "frames come from the server alone");
    auto read = wire::read_client_message(message.bytes);
    if (!read) return not_understood(message.bytes, read.error());
    if (!m_is_greeted) return greet(*read);
    m_daemon.obey(m_client, *read);
}

void Connection::greet(const wire::ClientMessage& message) {
    const auto* hello = std::get_if<wire::Hello>(&message);
    if (hello == nullptr) {
        const std::string id = wire::request_id(message);
        m_client->tell(wire::Refused{id.empty() ? std::nullopt : std::optional(id), {ErrorCode::usage, "the first message is hello", "type"}, {}});
        return m_client->close(1002, "the first message is hello");
    }
    if (std::ranges::find(hello->versions, wire::protocol_version) == hello->versions.end()) {
        m_client->tell(wire::Unsupported{{wire::protocol_version}});
        return m_client->close(1002, "there is no version that both speak");
    }
    m_is_greeted = true;
    m_client->tell(wire::Welcome{wire::protocol_version, m_server, m_visitor.is_local ? std::nullopt : std::optional(m_visitor.person)});
    m_daemon.greet(m_client);
}

void Connection::not_understood(const std::string& text, const Error& error) {
    m_client->tell(wire::Refused{wire::request_of(text), error, {}});
    if (!m_is_greeted) m_client->close(1002, "the first message is hello");
    else if (++m_not_understood >= most_not_understood) m_client->throw_out("too many messages that cannot be read");
}

}  // namespace weave::simd
