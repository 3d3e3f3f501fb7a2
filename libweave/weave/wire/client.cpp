#include <weave/wire/client.hpp>

#include <weave/core/json_reader.hpp>
#include <weave/core/text.hpp>

#include <algorithm>
#include <array>
#include <random>
#include <type_traits>
#include <utility>

namespace weave::wire {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// A server that sends more than this while it owes an answer is not listened to for longer.
constexpr std::size_t most_kept = 20'000;
constexpr std::size_t longest_told = 1'000;  ///< bytes of a text of the server's in a message for people

net::Headers headers_of(const ServerPlace& place) {
    if (place.token.empty()) return {};
    return {{"Authorization", "Bearer " + place.token}};
}

milliseconds until(Clock::time_point end) {
    return std::max(milliseconds(0), std::chrono::duration_cast<milliseconds>(end - Clock::now()));
}

/// What a close means to a client: of kind system where another connection may go better.
Error meaning_of(const net::WebSocketEnd& end) {
    switch (end.code) {
        case 1000: return system_fault("the server has ended the connection");
        case 1001: return system_fault("the server has stopped");
        case 1002: return bad_input("the connection ended, as one side did not keep to the protocol");
        case 1003: return bad_input("the server does not take this kind of message");
        case 1007: return bad_input("the connection ended over text that is no UTF-8");
        case 1008: return {ErrorCode::refused, "the server does not permit it (or no longer: a token lasts for hours)", {}};
        case 1009: return bad_input("the connection ended over a message that is too long");
        case 1011: return system_fault("the server has a fault");
        case 1013: return system_fault("the server has let go of a client that read too slowly");
        default: return system_fault("the connection broke (" + std::to_string(end.code) + ")");
    }
}

std::string told(const std::string& words) {
    return on_one_line(words.substr(0, longest_told));
}

template <class M>
std::string request_in(const M& message) {
    if constexpr (requires { message.request; }) return message.request;
    else return {};
}

/// An error that the server tells in an answer of HTTP.
Error error_in(const net::Response& response) {
    const bool passes = response.status >= 500 || response.status == 429;
    Error error{passes ? ErrorCode::system : ErrorCode::refused, "the server answers " + std::to_string(response.status), {}};
    const auto body = parse_json(response.body ? std::string_view(*response.body) : std::string_view());
    if (!body || !body->is_object() || !body->contains("error")) return error;
    const Json& cause = body->at("error");
    if (cause.is_object() && cause.contains("message") && cause.at("message").is_string())
        error.message += ": " + told(cause.at("message").get<std::string>());
    return error;
}

std::string target_of(const char* kind, std::uint64_t number, const char* what) {
    return "/api/v1/" + std::string(kind) + "/" + std::to_string(number) + "/" + what;
}

}  // namespace

std::string new_request_id() {
    std::random_device random;
    std::string id;
    for (int k = 0; k < 4; ++k) {
        std::array<char, 9> digits{};
        std::snprintf(digits.data(), digits.size(), "%08x", static_cast<unsigned>(random()));
        id += digits.data();
    }
    return id;
}

std::string request_id(const ClientMessage& message) {
    return std::visit([](const auto& alternative) { return request_in(alternative); }, message);
}

std::string answered_id(const ServerMessage& message) {
    if (const auto* refused = std::get_if<Refused>(&message)) return refused->request.value_or("");
    if (const auto* accepted = std::get_if<Accepted>(&message)) return accepted->request;
    if (const auto* state = std::get_if<State>(&message)) return state->request;
    if (const auto* jobs = std::get_if<JobList>(&message)) return jobs->request;
    if (const auto* sessions = std::get_if<SessionList>(&message)) return sessions->request;
    return {};
}

Result<Client> Client::connect(const ServerPlace& place, const std::string& name) {
    net::ClientOptions options = place.options;
    options.most_body_bytes = most_frame_bytes;
    auto socket = net::WebSocketClient::connect(options, "/api/v1/wire", headers_of(place));
    if (!socket) return std::move(socket).error();
    Client client(std::move(*socket), place.name);
    WEAVE_CHECK_OK(client.greet(name, options.answer_time));
    return client;
}

Status Client::greet(const std::string& name, milliseconds patience) {
    WEAVE_CHECK_OK(send(Hello{{protocol_version}, name}));
    WEAVE_TRY(const std::optional<Received> first, receive_new(patience));
    if (!first) return system_fault("the server does not answer in time", m_place);
    const auto* message = std::get_if<ServerMessage>(&*first);
    const auto* refused = message != nullptr ? std::get_if<Refused>(message) : nullptr;
    if (refused != nullptr) return Error{refused->error}.in(m_place);
    if (message != nullptr && std::holds_alternative<Unsupported>(*message))
        return bad_input("the server speaks other versions of the protocol than this program", m_place);
    const auto* welcome = message != nullptr ? std::get_if<Welcome>(message) : nullptr;
    if (welcome == nullptr) return bad_input("the server does not begin as the protocol says", m_place);
    if (welcome->version != protocol_version) return bad_input("the server chose a version that was not offered", m_place);
    m_welcome = *welcome;
    return {};
}

Status Client::send(const ClientMessage& message) {
    std::string text = write_message(message);
    if (auto same = read_client_message(text); !same)
        return Error{ErrorCode::usage, std::move(same.error().message), std::move(same.error().where)};
    if (m_socket.send(std::move(text))) return {};
    return ended();
}

Result<Received> Client::read(const net::WebSocketMessage& message) const {
    const auto unreadable = [&](const Error& error) {
        return bad_input("the server sends what cannot be read: " + told(error.text()), m_place);
    };
    if (message.binary) {
        auto frame = decode_frame(message.bytes);
        if (!frame) return unreadable(frame.error());
        return Received(std::move(*frame));
    }
    auto text = read_server_message(message.bytes);
    if (!text) return unreadable(text.error());
    return Received(std::move(*text));
}

Result<std::optional<Received>> Client::receive_new(milliseconds patience) {
    auto message = m_socket.receive(patience);
    if (!message) return ended();
    if (!*message) return std::optional<Received>();
    auto received = read(**message);
    if (!received) return std::move(received).error();
    return std::optional<Received>(std::move(*received));
}

Result<std::optional<Received>> Client::receive(milliseconds patience) {
    if (m_kept.empty()) return receive_new(patience);
    std::optional<Received> first = std::move(m_kept.front());
    m_kept.pop_front();
    return first;
}

Status Client::keep(Received received) {
    if (std::holds_alternative<Frame>(received)) std::erase_if(m_kept, [](const Received& kept) { return std::holds_alternative<Frame>(kept); });
    if (m_kept.size() == most_kept) return bad_input("the server sends all kinds of things, but not the answer", m_place);
    m_kept.push_back(std::move(received));
    return {};
}

Result<ServerMessage> Client::ask(const ClientMessage& message, milliseconds patience) {
    const std::string id = request_id(message);
    if (id.empty()) return Error{ErrorCode::usage, "nobody answers this message", {}};
    const auto end = Clock::now() + patience;
    WEAVE_CHECK_OK(send(message));
    while (true) {
        WEAVE_TRY(std::optional<Received> received, receive_new(until(end)));
        if (!received) return system_fault("the server does not answer in time", m_place);
        auto* answer = std::get_if<ServerMessage>(&*received);
        if (answer != nullptr && answered_id(*answer) == id) return std::move(*answer);
        WEAVE_CHECK_OK(keep(std::move(*received)));
    }
}

void Client::close() {
    m_socket.close();
}

Error Client::ended() const {
    const auto end = m_socket.end();
    if (!end) return system_fault("the server takes nothing any more", m_place);
    Error error = meaning_of(*end);
    if (!end->reason.empty()) error.message += ": " + told(end->reason);
    return std::move(error).in(m_place);
}

std::string session_yarns(std::uint64_t session) {
    return target_of("sessions", session, "yarns");
}
std::string job_yarns(std::uint64_t job) {
    return target_of("jobs", job, "yarns");
}
std::string job_evidence(std::uint64_t job) {
    return target_of("jobs", job, "evidence");
}

Result<std::string> download(const ServerPlace& place, const std::string& target, std::uint64_t most) {
    std::string bytes;
    net::HttpClient client(place.options);
    const auto take = [&](std::string_view piece) {
        if (piece.size() > most - bytes.size())
            return Status(bad_input("the server sends more than " + std::to_string(most) + " bytes", place.name));
        bytes += piece;
        return Status();
    };
    auto response = client.send({"GET", target, headers_of(place), {}}, take);
    if (!response) return std::move(response).error();
    if (response->status != 200) return error_in(*response).in(place.name);
    return bytes;
}

}  // namespace weave::wire
