#include <weave/wire/mill_client.hpp>

#include <weave/core/text.hpp>
#include <weave/keys/codes.hpp>
#include <weave/keys/secret_bytes.hpp>
#include <weave/net/target.hpp>

#include <chrono>
#include <thread>
#include <utility>

namespace weave::wire {

namespace {

constexpr int most_tries = 3;
constexpr std::chrono::milliseconds first_pause{500};

ErrorCode code_of(const std::string& kind, int status) {
    for (const ErrorCode code :
         {ErrorCode::usage, ErrorCode::bad_input, ErrorCode::invalid, ErrorCode::refused, ErrorCode::system})
        if (kind == kind_of(code)) return code;
    return status >= 500 ? ErrorCode::system : ErrorCode::bad_input;
}

/// What was asked for, as people write it: `looms/EP 1`.
std::string place_of(const std::string& path) {
    const auto decoded = net::percent_decoded(path.substr(1));
    return on_one_line(decoded ? *decoded : path.substr(1));
}

/// What an answer other than 200 says. A refusal's place is a word for programs, so people are told what was
/// asked for instead.
Error error_of(const net::Response& response, const std::string& path) {
    const auto json = parse_json(response.body ? *response.body : "");
    const Json told = json && json->is_object() ? json->value("error", Json::object()) : Json::object();
    const auto text = [&](const char* member) {
        return told.is_object() && told.contains(member) && told[member].is_string()
                   ? told[member].get<std::string>()
                   : std::string();
    };
    Error error{code_of(text("kind"), response.status), text("message"), text("where")};
    if (error.message.empty())
        error.message = "the server answers " + std::to_string(response.status) + " " +
                        std::string(net::reason_of(response.status));
    if (error.code == ErrorCode::refused || error.code == ErrorCode::system || error.where.empty())
        error.where = place_of(path);
    return error;
}

Result<Json> json_of(const Result<net::Response>& response, const std::string& path) {
    if (!response) return response.error();
    if (response->status != 200) return error_of(*response, path);
    auto json = parse_json(response->body ? *response->body : "");
    if (json && json->is_object()) return json;
    return bad_input("the server's answer is no JSON object", place_of(path));
}

std::string target_of(const std::string& path, const net::Parameters& query) {
    std::string target = mill_api_root + path;
    char before = '?';
    for (const auto& [name, value] : query) {
        target += before + name + "=" + net::percent_encoded(value);
        before = '&';
    }
    return target;
}

void wipe_secrets(Json& body) {
    for (const char* member : {"password", "old", "new", "code"})
        if (body.contains(member) && body[member].is_string()) wipe(body[member].get_ref<std::string&>());
}

/// Whether nobody knows what came of a change: the way was lost, or the server's store.
bool may_be_done(const Result<net::Response>& response) {
    return response ? response->status == 504 : response.error().code == ErrorCode::system;
}

/// Whether it is worth asking again: that, or the request did not get a turn.
bool may_have_failed(const Result<net::Response>& response) {
    return may_be_done(response) || (response && response->status == 503);
}

Error lacks(const std::string& member) {
    return bad_input("the server's answer lacks it", member);
}

}  // namespace

std::string mill_path(std::initializer_list<std::string> segments) {
    std::string path;
    for (const std::string& segment : segments) path += "/" + net::percent_encoded(segment);
    return path;
}

MillClient::MillClient(MillSession session, net::ClientOptions options)
    : m_session(std::move(session)), m_options(options), m_http(std::move(options)) {}

Result<MillClient> MillClient::of(MillSession session) {
    WEAVE_TRY(net::ClientOptions options, client_options(session));
    return MillClient(std::move(session), std::move(options));
}

net::Headers MillClient::headers() const {
    net::Headers headers;
    if (!m_session.token.empty()) headers.set("Authorization", "Bearer " + m_session.token);
    return headers;
}

Result<net::Response> MillClient::send(net::ClientRequest& request, const net::Sink* sink) {
    if (m_progress)
        request.progress = [this, of = request.body.size()](std::size_t sent) { return m_progress(sent, of); };
    auto response = sink != nullptr ? m_http.send(request, *sink) : m_http.send(request);
    m_signed_out = response && response->status == 401;
    return response;
}

Result<Json> MillClient::get(const std::string& path, const net::Parameters& query) {
    net::ClientRequest request{"GET", target_of(path, query), headers(), ""};
    return json_of(send(request), path);
}

Result<std::string> MillClient::get_bytes(const std::string& path, const net::Parameters& query,
                                         std::size_t most) {
    std::string bytes;
    const net::Sink keep = [&](std::string_view piece) -> Status {
        if (piece.size() > most - bytes.size())
            return bad_input("the answer has more than " + counted(most, "byte"), place_of(path));
        bytes += piece;
        return {};
    };
    net::ClientRequest request{"GET", target_of(path, query), headers(), ""};
    WEAVE_TRY(const net::Response response, send(request, &keep));
    if (response.status != 200) return error_of(response, path);
    return bytes;
}

Result<Json> MillClient::change(const std::string& method, const std::string& path, Json body) {
    body["request"] = make_token();
    net::ClientRequest request{method, target_of(path, {}), headers(),
                               body.dump(-1, ' ', false, Json::error_handler_t::replace)};
    wipe_secrets(body);
    request.headers.set("Content-Type", "application/json");
    auto response = send(request);
    bool is_unsure = may_be_done(response);
    auto pause = first_pause;
    for (int tries = 1; tries < most_tries && may_have_failed(response); ++tries, pause *= 2) {
        response = waits(pause) ? send(request) : Error{ErrorCode::refused, "the request was given up", place_of(path)};
        is_unsure |= may_be_done(response);
    }
    wipe(request.body);
    if (is_unsure && response && response->status == 503)  // it speaks of the last try alone
        return system_fault("an earlier try of this may have been recorded, and now the server cannot say: look before you repeat it",
                            place_of(path));
    return json_of(response, path);
}

/// Waits; false where the request was given up meanwhile.
bool MillClient::waits(std::chrono::milliseconds time) const {
    constexpr std::chrono::milliseconds glance{50};
    for (; time > glance && m_progress; time -= glance) {
        if (!m_progress(0, 0)) return false;
        std::this_thread::sleep_for(glance);
    }
    std::this_thread::sleep_for(time);
    return true;
}

Result<net::WebSocketClient> MillClient::watch(const std::string& path) const {
    return net::WebSocketClient::connect(m_options, target_of(path, {}), headers());
}

Result<std::string> text_member(const Json& answer, const std::string& member) {
    if (!answer.contains(member) || !answer.at(member).is_string()) return lacks(member);
    return answer.at(member).get<std::string>();
}

Result<std::int64_t> number_member(const Json& answer, const std::string& member) {
    if (!answer.contains(member) || !answer.at(member).is_number_integer()) return lacks(member);
    return answer.at(member).get<std::int64_t>();
}

Result<std::vector<std::string>> texts_member(const Json& answer, const std::string& member) {
    if (!answer.contains(member) || !answer.at(member).is_array()) return lacks(member);
    std::vector<std::string> texts;
    for (const Json& entry : answer.at(member)) {
        if (!entry.is_string()) return lacks(member);
        texts.push_back(entry.get<std::string>());
    }
    return texts;
}

}  // namespace weave::wire
