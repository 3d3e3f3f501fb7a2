#include <loomlink/commands/client_command.hpp>

#include <utility>

namespace weave::loomlink {

Result<std::filesystem::path> ClientWish::session_path() const {
    if (!session_file.empty()) return std::filesystem::path(session_file);
    return wire::usual_session_file();
}

Result<wire::MillClient> ClientWish::connect() const {
    WEAVE_TRY(const auto file, session_path());
    WEAVE_TRY(wire::MillSession session, wire::load_session(file));
    if (session.origin.empty())
        return Error{ErrorCode::refused, "you have not signed in here: loomlink login", file.string()};
    return wire::MillClient::of(std::move(session));
}

ClientCommand add_client_command(CLI::App& app, CommandOutcome& outcome, const std::string& name,
                                 const std::string& help, const std::string& example) {
    const ClientCommand made{add_command(app, outcome, name, help, example), std::make_shared<ClientWish>()};
    add_text(made.command, "--session", made.wish->session_file,
             "the file that says which server and as whom, as login wrote it")
        ->type_name("FILE");
    return made;
}

void add_password_option(const ClientCommand& command) {
    add_text(command.command, "--password-file", command.wish->password_file,
             "read the password from a file (a line), or from standard input (-), in place of the terminal")
        ->type_name("FILE");
}

void on_client_run(const ClientCommand& command, CommandOutcome& outcome,
                   std::function<Status(wire::MillClient&)> run) {
    on_run(command.command, outcome, [wish = command.wish, run = std::move(run)]() -> Status {
        WEAVE_TRY(wire::MillClient client, wish->connect());
        Status done = run(client);
        if (done || !client.is_signed_out()) return done;
        Error error = std::move(done).error();
        error.message += " (loomlink login)";
        return error;
    });
}

Result<std::string> password_to_sign(const wire::MillClient& client, const ClientWish& wish) {
    PasswordSource source(wish.password_file);
    return source.ask("Password of " + client.session().name + ", to sign");
}

Result<Json> sign_and_post(wire::MillClient& client, const ClientWish& wish, const std::string& path, Json body) {
    WEAVE_TRY(body["password"], password_to_sign(client, wish));
    return client.post(path, std::move(body));
}

}  // namespace weave::loomlink
