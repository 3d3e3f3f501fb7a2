#include <weave/command/command.hpp>

#include <weave/core/exit_code.hpp>
#include <weave/core/log.hpp>
#include <weave/core/text.hpp>

#include <algorithm>
#include <csignal>
#include <iostream>
#include <new>
#include <string_view>
#include <utility>
#include <vector>

namespace weave {

namespace {

constexpr const char* endings =
    "Exit status: 0 done, 1 findings or a refusal by validation, 2 usage, 3 bad input, 4 refused, 5 a fault "
    "of the system.";

bool asks_for_json(int count, char** words) {
    return std::any_of(words + 1, words + count,
                       [](const char* word) { return std::string_view(word) == "--json"; });
}

/// The commands that a group has: `list, invite and join`.
std::string commands_of(const CLI::App& group) {
    const auto commands = group.get_subcommands([](const CLI::App*) { return true; });
    std::string names;
    for (std::size_t k = 0; k < commands.size(); ++k)
        names += (k == 0 ? "" : k + 1 == commands.size() ? " and " : ", ") + commands[k]->get_name();
    return names;
}

/// The command that a call names, as far as it names one.
const CLI::App& command_named(const CLI::App& app) {
    const CLI::App* last = &app;
    while (!last->get_subcommands().empty()) last = last->get_subcommands().front();
    return *last;
}

/// As it is called: `loomlink user join`.
std::string whole_name(const CLI::App& command) {
    const CLI::App* const group = command.get_parent();
    return (group == nullptr ? "" : whole_name(*group) + " ") + command.get_name();
}

/// What a command was told beyond what it takes: an option that it has not, else the first word too many.
std::string word_too_many(const std::vector<std::string>& words) {
    const auto option = std::find_if(words.begin(), words.end(), [](const std::string& word) { return word.starts_with('-'); });
    return option == words.end() ? "'" + words.front() + "' is one word too many" : "there is no option '" + *option + "' here";
}

/// What is wrong with a call that could not be parsed, in a sentence. CLI11 asks for a command before it
/// looks at words it does not know.
std::string usage_trouble(const CLI::App& app, const CLI::ParseError& trouble) {
    const CLI::App* const last = &command_named(app);
    auto unknown = last->remaining();
    if (last->get_require_subcommand_min() == 0)
        return dynamic_cast<const CLI::ExtrasError*>(&trouble) == nullptr || unknown.empty() ? trouble.what() : word_too_many(unknown);
    std::erase(unknown, "--json");  // which says how to answer, and is no reason
    const std::string has = last == &app ? "" : "; " + last->get_name() + " has " + commands_of(*last);
    if (unknown.empty()) return last == &app ? "name a command" : "name what to do" + has;
    const bool option = unknown.front().starts_with('-');
    return "there is no " + std::string(option ? "option" : "command") + " '" + unknown.front() + "'" +
           (last == &app ? "" : " of " + last->get_name()) + has;
}

void parse(CLI::App& app, CommandOutcome& outcome, int count, char** words) {
    try {
        app.parse(count, words);
    } catch (const CLI::ParseError& trouble) {
        if (trouble.get_exit_code() == 0) {
            app.exit(trouble);  // tells what --help and --version ask for
            return;
        }
        outcome.json = asks_for_json(count, words);  // which the parser need not have reached
        outcome.fail({ErrorCode::usage, usage_trouble(app, trouble), ""});
        const std::string name = whole_name(command_named(app));
        const bool has_commands = command_named(app).get_require_subcommand_min() > 0;
        std::cerr << "Try '" << name << " --help'" << (has_commands ? " or '" + name + " COMMAND --help'" : "") << ".\n";
    } catch (const std::bad_alloc&) {
        outcome.fail(system_fault("this machine has not enough memory for it"));
    } catch (const std::exception& trouble) {
        outcome.fail(system_fault(trouble.what()));
    }
}

}  // namespace

void prepare_program(CLI::App& app, const std::string& version) {
    app.get_formatter()->label("SUBCOMMAND", "COMMAND ...");
    app.get_formatter()->label("TEXT", "");  // what a word stands for says more than that it is text
    app.set_help_flag("-h,--help", "tell this and end");
    app.set_version_flag("--version", app.get_name() + " " + version, "tell the version and end");
    app.require_subcommand(1);
    app.footer(endings);  // which the commands inherit
}

CLI::App* add_command(CLI::App& app, CommandOutcome& outcome, const std::string& name,
                      const std::string& help, const std::string& example) {
    CLI::App* command = app.add_subcommand(name, help)->group("Commands");
    command->add_flag("--json", outcome.json, "answer with one JSON object on standard output");
    if (!example.empty()) command->footer("Example: " + example + "\n" + command->get_footer());
    return command;
}

CLI::Validator one_of(const std::vector<std::string>& choices) {
    const auto check = [choices](std::string& word) {
        if (std::find(choices.begin(), choices.end(), word) != choices.end()) return std::string();
        std::string all;
        for (const std::string& choice : choices) all += (all.empty() ? "" : ", ") + choice;
        return "'" + on_one_line(word) + "' is none of " + all;
    };
    return {check, ""};
}

void on_run(CLI::App* command, CommandOutcome& outcome, std::function<Status()> run) {
    command->callback([&outcome, run = std::move(run)] {
        if (Status status = run(); !status) outcome.fail(status.error());
    });
}

int run_program(CLI::App& app, CommandOutcome& outcome, int count, char** words) {
    std::signal(SIGXFSZ,
                SIG_IGN);  // a file past the limit is an error to tell and tidy up after, not our end
    set_log_sink([&outcome](LogLevel level, std::string_view message) {
        if (level != LogLevel::debug) outcome.note(std::string(message));
    });
    app.footer("'" + app.get_name() + " COMMAND --help' tells what a command takes.\n" + endings);
    parse(app, outcome, count, words);
    set_log_sink({});
    std::cout.flush();
    if (std::cout) return outcome.exit_code;
    std::cerr << app.get_name() << ": cannot write the answer to standard output\n";
    return exit_code_of(ErrorCode::system);
}

}  // namespace weave
