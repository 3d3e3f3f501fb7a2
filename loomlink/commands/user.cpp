// user: who may come in, and what each may do.

#include <weave/core/text.hpp>
#include <weave/keys/secret_bytes.hpp>

#include <loomlink/commands/bootstrap.hpp>
#include <loomlink/commands/client_command.hpp>
#include <loomlink/commands/names.hpp>
#include <weave/wire/mill_sign_in.hpp>

namespace weave::loomlink {

namespace {

const std::vector<std::string> role_names{"designer", "approver", "operator", "engineer", "admin"};

CLI::Option* add_roles(CLI::App* command, std::vector<std::string>& roles) {
    return command
        ->add_option("ROLE", roles, "what the person may do: designer, approver, operator, engineer, admin")
        ->check(one_of(role_names))
        ->type_name("")
        ->required();
}

/// A new code, and the link that a browser or `user join` takes.
void tell_code(const wire::MillClient& client, const Json& answer, CommandOutcome& outcome) {
    const std::string link = client.session().origin + "/join#" + told(answer, "code");
    Json json = answer;
    json["link"] = link;
    outcome.answer(json, "Hand this on; it can be used once, until " + told(answer, "expires") + ":\n" +
                             on_one_line(link) + "\n");
}

Status list_people(wire::MillClient& client, CommandOutcome& outcome) {
    WEAVE_TRY(const Json answer, client.get("/people"));
    std::vector<std::vector<std::string>> lines;
    for (const Json& person : entries(answer, "people"))
        lines.push_back({told(person, "name"), told(person, "full_name"), told(person, "roles"),
                         told(person, "active") == "true" ? "" : "may not sign in"});
    outcome.answer(answer, as_list(in_columns(lines)));
    return {};
}

struct JoinWish {
    std::string code, origin, fingerprint, name, full_name;
};

/// A link as `user invite` tells it is taken apart.
JoinWish without_link(JoinWish wish) {
    constexpr std::string_view separator = "/join#";
    const std::size_t at = wish.code.find(separator);
    if (at == std::string::npos) return wish;
    if (wish.origin.empty()) wish.origin = wish.code.substr(0, at);
    wish.code = wish.code.substr(at + separator.size());
    return wish;
}

Status join(const ClientWish& wish, const JoinWish& join_wish, CommandOutcome& outcome) {
    WEAVE_TRY(const auto file, wish.session_path());
    WEAVE_TRY(const wire::MillSession server, wire::server_wished(join_wish.origin, join_wish.fingerprint));
    WEAVE_TRY(wire::MillClient client, wire::MillClient::of(server));
    PasswordSource source(wish.password_file);
    WEAVE_TRY(std::string password, source.ask_new("Password for " + join_wish.name + ", of 12 or more"));
    Json body{{"code", join_wish.code},
              {"name", join_wish.name},
              {"full_name", join_wish.full_name},
              {"password", password}};
    wipe(password);
    WEAVE_TRY(const Json answer, client.post("/invitations/accept", std::move(body)));
    WEAVE_CHECK_OK(wire::continue_as_told(client, answer, join_wish.name));
    WEAVE_CHECK_OK(wire::save_session(file, client.session()));
    outcome.answer({{"origin", server.origin}, {"person", answer.value("person", Json())}},
                   on_one_line(join_wish.name) + " has joined and is signed in\n");
    return {};
}

void add_join(CLI::App& app, CommandOutcome& outcome) {
    const auto command =
        add_client_command(app, outcome, "join", "Join with an invitation, choose a password, and sign in",
                           "loomlink user join https://mill:8443/join#k7tq-… --fingerprint 4f3a… --name dora "
                           "--full-name 'Dora Dean'");
    add_password_option(command);
    const auto wish = std::make_shared<JoinWish>();
    add_text(command.command, "CODE", wish->code, "the code of the invitation, or the link with it")
        ->required();
    add_text(command.command, "--server", wish->origin,
             "the server, such as https://mill:8443, where the link does not say it")
        ->type_name("ORIGIN");
    add_text(command.command, "--fingerprint", wish->fingerprint, "SHA-256 of the server's certificate")
        ->type_name("HEX");
    add_text(command.command, "--name", wish->name, "the name to sign in with")
        ->type_name("NAME")
        ->required();
    add_words(command.command, "--full-name", wish->full_name, "stands beside everything that you sign")
        ->type_name("NAME")
        ->required();
    on_run(command.command, outcome,
           [client = command.wish, wish, &outcome] { return join(*client, without_link(*wish), outcome); });
}

Status change_password(wire::MillClient& client, const ClientWish& wish, CommandOutcome& outcome) {
    PasswordSource source(wish.password_file);
    Json body = Json::object();
    WEAVE_TRY(body["old"], source.ask("Password until now"));
    WEAVE_TRY(body["new"], source.ask_new("New password"));
    WEAVE_CHECK_OK(client.post("/me/password", std::move(body)));
    outcome.answer({{"changed", true}},
                   "The password is changed and all sessions are ended: loomlink login\n");
    return {};
}

void add_named_steps(CLI::App& app, CommandOutcome& outcome) {
    const auto name = std::make_shared<std::string>();
    const auto roles = std::make_shared<std::vector<std::string>>();
    const auto set_roles = add_client_command(app, outcome, "roles", "Set what a person may do, from now on",
                                              "loomlink user roles dora designer approver");
    add_name(set_roles.command, "NAME", *name, "the person")->required();
    add_roles(set_roles.command, *roles);
    on_client_run(set_roles, outcome, [name, roles, &outcome](wire::MillClient& client) -> Status {
        WEAVE_TRY(const Json answer, client.post(wire::mill_path({"people", *name, "roles"}), {{"roles", *roles}}));
        outcome.answer(answer, on_one_line(*name) + ": " + told(answer, "roles") + "\n");
        return {};
    });
    for (const bool enable : {false, true}) {
        const std::string step = enable ? "enable" : "disable";
        const auto command = add_client_command(
            app, outcome, step, enable ? "Let a person sign in again" : "Let a person sign in no more");
        add_name(command.command, "NAME", *name, "the person")->required();
        on_client_run(command, outcome, [name, step, enable, &outcome](wire::MillClient& client) -> Status {
            WEAVE_TRY(const Json answer, client.post(wire::mill_path({"people", *name, step})));
            outcome.answer(answer,
                           on_one_line(*name) + (enable ? " may sign in\n" : " may not sign in any more\n"));
            return {};
        });
    }
    const auto reset = add_client_command(
        app, outcome, "reset", "Revoke the key of a person who lost the password, and invite anew");
    add_name(reset.command, "NAME", *name, "the person")->required();
    on_client_run(reset, outcome, [name, &outcome](wire::MillClient& client) -> Status {
        WEAVE_TRY(const Json answer, client.post(wire::mill_path({"people", *name, "reset"})));
        tell_code(client, answer, outcome);
        return {};
    });
}

}  // namespace

void add_user_commands(CLI::App& app, CommandOutcome& outcome) {
    CLI::App& user = add_group(app, "user", "People: invite, join, roles, passwords");
    const auto list = add_client_command(user, outcome, "list", "List all people and what each may do");
    on_client_run(list, outcome, [&outcome](wire::MillClient& client) { return list_people(client, outcome); });
    const auto invite = add_client_command(user, outcome, "invite", "Make an invitation for somebody",
                                           "loomlink user invite designer approver");
    const auto roles = std::make_shared<std::vector<std::string>>();
    add_roles(invite.command, *roles);
    on_client_run(invite, outcome, [roles, &outcome](wire::MillClient& client) -> Status {
        WEAVE_TRY(const Json answer, client.post("/invitations", {{"roles", *roles}}));
        tell_code(client, answer, outcome);
        return {};
    });
    add_user_bootstrap(user, outcome);
    add_join(user, outcome);
    add_named_steps(user, outcome);
    const auto password = add_client_command(
        user, outcome, "password", "Change your password; of a --password-file the old one is line 1");
    add_password_option(password);
    on_client_run(password, outcome, [wish = password.wish, &outcome](wire::MillClient& client) {
        return change_password(client, *wish, outcome);
    });
}

}  // namespace weave::loomlink
