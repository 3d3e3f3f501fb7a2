#pragma once

#include <functional>
#include <weave/wire/mill_client.hpp>
#include <loomlink/commands/command.hpp>
#include <loomlink/commands/password_source.hpp>
#include <loomlink/commands/words.hpp>
#include <memory>
#include <string>

namespace weave::loomlink {

/// What a command that talks to the server was told beside its own words.
struct ClientWish {
    std::string session_file;   ///< empty: the usual one
    std::string password_file;  ///< of signed steps

    [[nodiscard]] Result<std::filesystem::path> session_path() const;
    /// A client as the person of the session.
    [[nodiscard]] Result<wire::MillClient> connect() const;
};

/// A command that talks to the server.
struct ClientCommand {
    CLI::App* command;
    std::shared_ptr<ClientWish> wish;
};

/// Adds a command with --json and --session.
ClientCommand add_client_command(CLI::App& app, CommandOutcome& outcome, const std::string& name,
                                 const std::string& help, const std::string& example = {});

/// Lets the command take its password from elsewhere than the terminal.
void add_password_option(const ClientCommand& command);

/// Lets `run` be the command's work, once it is clear which server is meant and who asks.
void on_client_run(const ClientCommand& command, CommandOutcome& outcome,
                   std::function<Status(wire::MillClient&)> run);

/// The person types the password for a step that is signed.
Result<std::string> password_to_sign(const wire::MillClient& client, const ClientWish& wish);

/// Sends a step that is signed: the person types the password for it.
Result<Json> sign_and_post(wire::MillClient& client, const ClientWish& wish, const std::string& path, Json body);

}  // namespace weave::loomlink
