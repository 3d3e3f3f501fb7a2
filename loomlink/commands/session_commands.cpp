// login, logout, me: which server is meant, who asks, and what waits for that person.

#include <weave/core/text.hpp>

#include <loomlink/commands/client_command.hpp>
#include <weave/wire/mill_sign_in.hpp>

namespace weave::loomlink {

namespace {

struct LoginWish {
    std::string origin, name, fingerprint;
};

Status log_in(const ClientWish& wish, const LoginWish& login, CommandOutcome& outcome) {
    WEAVE_TRY(const auto file, wish.session_path());
    WEAVE_TRY(const wire::MillSession before, wire::load_session(file));
    const std::string& name = login.name.empty() ? before.name : login.name;
    if (name.empty()) return Error{ErrorCode::usage, "say who you are", "--name"};
    WEAVE_TRY(const wire::MillSession server, wire::server_wished(login.origin, login.fingerprint, before));
    WEAVE_TRY(wire::MillClient client, wire::MillClient::of(server));
    PasswordSource source(wish.password_file);
    WEAVE_TRY(std::string password, source.ask("Password of " + name));
    WEAVE_TRY(const Json answer, wire::sign_in(client, name, std::move(password)));
    WEAVE_CHECK_OK(wire::save_session(file, client.session()));
    outcome.answer({{"origin", server.origin},
                    {"person", answer.value("person", Json())},
                    {"expires", answer.value("expires", Json())}},
                   on_one_line(name) + " is signed in at " + on_one_line(server.origin) + "\n");
    return {};
}

void add_login(CLI::App& app, CommandOutcome& outcome) {
    const auto command =
        add_client_command(app, outcome, "login", "Sign in; a session ends after half an hour without a call",
                           "loomlink login https://mill:8443 --name dora --fingerprint 4f3a…");
    add_password_option(command);
    const auto login = std::make_shared<LoginWish>();
    add_text(command.command, "ORIGIN", login->origin,
             "the server, such as https://mill:8443; the last one if not given");
    add_text(command.command, "--name", login->name, "who you are; whoever signed in last if not given")
        ->type_name("NAME");
    add_text(command.command, "--fingerprint", login->fingerprint,
             "SHA-256 of the server's certificate, as it told it when it started; kept from then on. Without "
             "it the system's authorities decide")
        ->type_name("HEX");
    on_run(command.command, outcome,
           [wish = command.wish, login, &outcome] { return log_in(*wish, *login, outcome); });
}

Status log_out(wire::MillClient& client, const ClientWish& wish, CommandOutcome& outcome) {
    WEAVE_CHECK_OK(client.post("/logout"));
    wire::MillSession session = client.session();
    session.token.clear();
    WEAVE_TRY(const auto file, wish.session_path());
    WEAVE_CHECK_OK(wire::save_session(file, session));
    outcome.answer({{"signed_in", false}}, "You are signed out.\n");
    return {};
}

Status tell_who(wire::MillClient& client, CommandOutcome& outcome) {
    WEAVE_TRY(Json me, client.get("/me"));
    WEAVE_TRY(const Json waiting, client.get("/me/waiting"));
    const Json person = me.value("person", Json::object());
    std::string words =
        told(person, "name") + " (" + told(person, "full_name") + "): " + told(person, "roles") + "\n" +
        in_columns(waiting, "items", {"what", "design", "revision", "loom", "release", "since"});
    outcome.answer({{"origin", client.session().origin},
                    {"person", person},
                    {"expires", me.value("expires", Json())},
                    {"waiting", waiting.value("items", Json::array())}},
                   words);
    return {};
}

}  // namespace

void add_session_commands(CLI::App& app, CommandOutcome& outcome) {
    add_login(app, outcome);
    const auto logout = add_client_command(app, outcome, "logout", "Sign out: the session counts no more");
    on_client_run(logout, outcome, [wish = logout.wish, &outcome](wire::MillClient& client) {
        return log_out(client, *wish, outcome);
    });
    const auto me = add_client_command(app, outcome, "me", "Tell who is signed in, and what waits for you");
    on_client_run(me, outcome, [&outcome](wire::MillClient& client) { return tell_who(client, outcome); });
}

}  // namespace weave::loomlink
