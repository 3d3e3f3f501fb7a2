#include <weave/wire/mill_sign_in.hpp>

#include <weave/keys/secret_bytes.hpp>

#include <utility>

namespace weave::wire {

Result<MillSession> server_wished(const std::string& origin, const std::string& fingerprint,
                                  const MillSession& before, const std::string& option) {
    MillSession session = before;
    session.token.clear();
    if (!origin.empty() && origin != before.origin) session = MillSession{origin, {}, {}, {}, {}};
    if (session.origin.empty())
        return Error{ErrorCode::usage, "say which server, such as https://mill:8443", ""};
    if (!fingerprint.empty()) {
        WEAVE_TRY(session.fingerprint,
                  parse_fingerprint(fingerprint, option, "as the server tells them when it starts"));
    }
    return session;
}

Result<Json> sign_in(MillClient& client, const std::string& name, std::string password) {
    Json body{{"name", name}, {"password", password}};
    wipe(password);
    WEAVE_TRY(Json answer, client.post("/login", std::move(body)));
    WEAVE_CHECK_OK(continue_as_told(client, answer, name));
    return answer;
}

Status continue_as_told(MillClient& client, const Json& answer, const std::string& name) {
    MillSession session = client.session();
    WEAVE_TRY(session.token, text_member(answer, "token"));
    session.name = name;
    client.continue_as(std::move(session));
    return {};
}

}  // namespace weave::wire
