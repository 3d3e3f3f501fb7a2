#pragma once

#include "command.hpp"

#include <weave/command/server_wish.hpp>
#include <weave/core/json.hpp>
#include <weave/wire/follower.hpp>

#include <cstdint>
#include <functional>
#include <string>

/// What the commands have in common that list what is yours on a server, jobs or sessions, and do something with one of these.
namespace weave::program {

/// One of them, by its number.
struct NumberedWish {
    ServerWish server;
    std::uint64_t number = 0;
};

/// Connects to the server that --on names. Errors: usage where it names none.
Result<wire::Follower> server_of(const ServerWish& wish);

/// A line for one of a list, from the members that its message gives it.
using LineOf = std::function<std::string(const Json&)>;

/// Answers with a list from the server, whose member `what` (`jobs`) has the items: each as the message has it, or as its line.
Status tell_list(CommandOutcome& outcome, const wire::Follower& follower, const std::string& what, const wire::ServerMessage& list, const LineOf& line_of);

/// `12  shoe: running, residual 1.56e-02 after 1200 steps`: the beginning of a line; `what` (`job`) is the member with its number.
std::string beginning_of(const Json& told, const char* what, const std::string& phase);

/// Adds a command of which `--on HOST` alone lists what there is, and commands below do something with one of it.
CLI::App* add_list_command(CLI::App& app, CommandOutcome& outcome, ServerWish& server, const std::string& name, const std::string& help, std::function<Status()> list);

/// Adds one of the commands below it, which takes a number.
CLI::App* add_numbered_command(CLI::App* list, CommandOutcome& outcome, NumberedWish& wish, const std::string& name, const std::string& help, const std::string& number_is);

}  // namespace weave::program
