#include <loomlink/service/answering.hpp>
#include <loomlink/service/gate.hpp>
#include <loomlink/service/handlers.hpp>
#include <utility>

namespace weave::loomlink {

namespace {

std::vector<std::string> texts(const Json& body, const std::string& field) {
    return body.value(field, std::vector<std::string>());
}

/// An answer that leaves the browser with this token as its cookie; an empty token takes the cookie away.
net::Response with_cookie(const ApiCall& call, const Result<Json>& answer, const std::string& token) {
    if (!answer) return trouble_answer(answer.error());
    net::CookieLife life{call.request.secure, {}};
    if (token.empty()) life.seconds = 0;
    const auto cookie = net::set_cookie(session_cookie, token, life);
    if (!cookie) return trouble_answer(cookie.error());
    net::Response response = net::json_answer(200, *answer);
    response.headers.add("Set-Cookie", *cookie);
    return response;
}

net::Response signed_in(const ApiCall& call, const Result<Json>& answer) {
    return with_cookie(call, answer, answer ? answer->value("token", std::string()) : std::string());
}

void add_own_account(ApiHandlers& handlers, Accounts& accounts) {
    auto& answers = handlers.answers;
    answers["login"] = [&accounts](const ApiCall& call) {
        return signed_in(call,
                         accounts.log_in(call.text("name"), call.text("password"), call.visitor.address));
    };
    answers["invitation.accept"] = [&accounts](const ApiCall& call) {
        return signed_in(call, accounts.join(call.text("code"), call.text("name"), call.text("full_name"),
                                             call.text("password"), call.visitor.address));
    };
    answers["logout"] = [&accounts](const ApiCall& call) {
        return with_cookie(call, accounts.log_out(call.visitor.token), {});
    };
    answers["me"] = answering([&accounts](const ApiCall& call) { return accounts.me(call.visitor.session); });
    answers["access.token"] = answering([&accounts](const ApiCall& call) {
        constexpr std::int64_t usual_hours = 8;  // a shift
        return accounts.access_token(call.visitor.caller(), ask_of(call), call.whole("hours").value_or(usual_hours));
    });
    answers["access.key"] =
        answering([&accounts](const ApiCall&) -> Result<Json> { return accounts.access_key(); });
    answers["me.password"] = answering([&accounts](const ApiCall& call) {
        return accounts.change_password(call.visitor.caller(), ask_of(call), call.text("old"),
                                        call.text("new"));
    });
}

}  // namespace

void add_account_handlers(ApiHandlers& handlers, Accounts& accounts) {
    add_own_account(handlers, accounts);
    auto& answers = handlers.answers;
    answers["invitation.make"] = answering([&accounts](const ApiCall& call) {
        return accounts.invite(call.visitor.caller(), ask_of(call), texts(call.body, "roles"));
    });
    answers["people"] =
        answering([&accounts](const ApiCall& call) { return accounts.people(call.visitor.caller()); });
    answers["person.roles"] = answering([&accounts](const ApiCall& call) {
        return accounts.set_roles(call.visitor.caller(), ask_of(call), call.place("name"),
                                  texts(call.body, "roles"));
    });
    for (const bool active : {false, true})
        answers[active ? "person.enable" : "person.disable"] =
            answering([&accounts, active](const ApiCall& call) {
                return accounts.set_active(call.visitor.caller(), ask_of(call), call.place("name"), active);
            });
    answers["person.reset"] = answering([&accounts](const ApiCall& call) {
        return accounts.reset(call.visitor.caller(), ask_of(call), call.place("name"));
    });
    answers["policy"] = answering([&accounts](const ApiCall&) { return accounts.policy(); });
    answers["policy.set"] = answering([&accounts](const ApiCall& call) {
        Json policy = call.body;
        policy.erase("request");
        return accounts.set_policy(call.visitor.caller(), ask_of(call), policy);
    });
}

}  // namespace weave::loomlink
