#include <loomlink/commands/sign_in.hpp>

#include <weave/keys/secret_bytes.hpp>

#include <utility>

namespace weave::loomlink {

Result<KeptSession> server_wished(const std::string& origin, const std::string& fingerprint,
                                  const KeptSession& before) {
    KeptSession session = before;
    session.token.clear();
    if (!origin.empty() && origin != before.origin) session = KeptSession{origin, {}, {}, {}, {}};
    if (session.origin.empty())
        return Error{ErrorCode::usage, "say which server, such as https://mill:8443", ""};
    if (!fingerprint.empty()) {
        WEAVE_TRY(session.fingerprint,
                  parse_fingerprint(fingerprint, "--fingerprint", "as the server tells them when it starts"));
    }
    return session;
}

Result<Json> sign_in(ApiClient& client, const std::string& name, std::string password) {
    Json body{{"name", name}, {"password", password}};
    wipe(password);
    WEAVE_TRY(Json answer, client.post("/login", std::move(body)));
    WEAVE_CHECK_OK(continue_as_told(client, answer, name));
    return answer;
}

Status continue_as_told(ApiClient& client, const Json& answer, const std::string& name) {
    KeptSession session = client.session();
    WEAVE_TRY(session.token, text_member(answer, "token"));
    session.name = name;
    client.continue_as(std::move(session));
    return {};
}

}  // namespace weave::loomlink
