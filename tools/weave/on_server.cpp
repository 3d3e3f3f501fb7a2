#include "on_server.hpp"

#include "remote_job.hpp"

#include <weave/core/text.hpp>

#include <cstdio>
#include <utility>

namespace weave::program {

Result<wire::Follower> server_of(const ServerWish& wish) {
    if (wish.host.empty()) return Error{ErrorCode::usage, "say on which server: --on HOST", ""};
    WEAVE_TRY(const wire::ServerPlace place, place_of(wish));
    return connected(place);
}

Status tell_list(CommandOutcome& outcome, const wire::Follower& follower, const std::string& what, const wire::ServerMessage& list, const LineOf& line_of) {
    WEAVE_TRY(Json told, parse_json(wire::write_message(list)));
    for (const char* of_the_message : {"type", "request"}) told.erase(of_the_message);
    told["server"] = follower.place().name;
    std::string words = told.at(what).empty() ? "no " + what + "\n" : "";
    for (const Json& one : told.at(what)) words += line_of(one) + "\n";
    outcome.answer(told, words);
    return {};
}

std::string beginning_of(const Json& told, const char* what, const std::string& phase) {
    std::string title = on_one_line(told.at("title").get<std::string>());
    if (title.empty()) title = "untitled";
    std::string line = std::to_string(told.at(what).get<std::uint64_t>()) + "  " + title + ": " + phase;
    if (!told.contains("residual")) return line;
    char text[100];
    std::snprintf(text, sizeof text, ", residual %.2e after %llu steps", told.at("residual").get<double>(),
                  static_cast<unsigned long long>(told.at("step").get<std::uint64_t>()));
    return line + text;
}

CLI::App* add_list_command(CLI::App& app, CommandOutcome& outcome, ServerWish& server, const std::string& name, const std::string& help, std::function<Status()> list) {
    CLI::App* command = add_command(app, outcome, name, help);
    add_server_options(command, server);
    on_run(command, outcome, [command, list = std::move(list)] { return command->get_subcommands().empty() ? list() : Status(); });
    return command;
}

CLI::App* add_numbered_command(CLI::App* list, CommandOutcome& outcome, NumberedWish& wish, const std::string& name, const std::string& help, const std::string& number_is) {
    CLI::App* command = add_command(*list, outcome, name, help);
    command->add_option("N", wish.number, number_is)->transform(between(std::int64_t{1}, static_cast<std::int64_t>(wire::most_number)))->required();
    add_server_options(command, wish.server);
    return command;
}

}  // namespace weave::program
