// The program `loomlink`: versions, approval, audit and loom files, as a service and on its command line.

#include <algorithm>
#include <csignal>
#include <iostream>
#include <loomlink/commands/command.hpp>
#include <new>
#include <string>
#include <string_view>

namespace {

constexpr const char* about = "Keeps designs, their approval and their release to looms.\n";

constexpr const char* endings =
    "Exit status: 0 done, 1 findings or a refusal by validation, 2 usage, 3 bad input, 4 refused, 5 a fault "
    "of the system.";

/// What is wrong with a call, in a sentence. CLI11 asks for a command before it looks at words it does not
/// know.
std::string usage_trouble(const CLI::App& app, const CLI::ParseError& trouble) {
    if (!app.get_subcommands().empty()) return trouble.what();
    const auto unknown = app.remaining();
    if (unknown.empty()) return "name a command";
    const bool option = unknown.front().starts_with('-');
    return "there is no " + std::string(option ? "option" : "command") + " '" + unknown.front() + "'";
}

bool asks_for_json(int count, char** words) {
    return std::any_of(words + 1, words + count,
                       [](const char* word) { return std::string_view(word) == "--json"; });
}

}  // namespace

int main(int count, char** words) {
    std::signal(SIGXFSZ, SIG_IGN);  // a file past the limit is an error to tell, not our end
    weave::loomlink::CommandOutcome outcome;
    CLI::App app(about, "loomlink");
    app.set_help_flag("-h,--help", "tell this and end");
    app.set_version_flag("--version", "loomlink " WEAVE_VERSION, "tell the version and end");
    app.require_subcommand(1);
    app.footer(endings);  // which the commands inherit
    weave::loomlink::add_init_command(app, outcome);
    weave::loomlink::add_serve_command(app, outcome);
    app.footer("'loomlink COMMAND --help' tells what a command takes.\n" + std::string(endings));
    try {
        app.parse(count, words);
    } catch (const CLI::ParseError& trouble) {
        if (trouble.get_exit_code() == 0) {
            app.exit(trouble);  // tells what --help and --version ask for
        } else {
            outcome.json = asks_for_json(count, words);  // which the parser need not have reached
            outcome.fail({weave::ErrorCode::usage, usage_trouble(app, trouble), ""});
            std::cerr << "Try 'loomlink --help' or 'loomlink COMMAND --help'.\n";
        }
    } catch (const std::bad_alloc&) {
        outcome.fail(weave::system_fault("this machine has not enough memory for it"));
    } catch (const std::exception& trouble) {
        outcome.fail(weave::system_fault(trouble.what()));
    }
    std::cout.flush();
    if (!std::cout) {
        std::cerr << "loomlink: cannot write the answer to standard output\n";
        return weave::loomlink::exit_code_of(weave::ErrorCode::system);
    }
    return outcome.exit_code;
}
