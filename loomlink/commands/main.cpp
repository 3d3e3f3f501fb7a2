// The program `loomlink`: versions, approval, audit and loom files, as a service and on its command line.

#include <weave/core/exit_code.hpp>
#include <weave/core/log.hpp>

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

bool asks_for_json(int count, char** words) {
    return std::any_of(words + 1, words + count,
                       [](const char* word) { return std::string_view(word) == "--json"; });
}

}  // namespace

int main(int count, char** words) {
    std::signal(SIGXFSZ, SIG_IGN);  // a file past the limit is an error to tell, not our end
    weave::set_log_sink([](weave::LogLevel level, std::string_view message) {
        if (level != weave::LogLevel::debug) weave::loomlink::CommandOutcome::note(std::string(message));
    });
    weave::loomlink::CommandOutcome outcome;
    CLI::App app(about, "loomlink");
    app.get_formatter()->label("SUBCOMMAND", "COMMAND ...");
    app.get_formatter()->label("TEXT", "");  // what a word stands for says more than that it is text
    app.set_help_flag("-h,--help", "tell this and end");
    app.set_version_flag("--version", "loomlink " WEAVE_VERSION, "tell the version and end");
    app.require_subcommand(1);
    app.footer(endings);  // which the commands inherit
    for (const auto add : {weave::loomlink::add_init_command, weave::loomlink::add_serve_command,
                           weave::loomlink::add_session_commands, weave::loomlink::add_user_commands,
                           weave::loomlink::add_policy_command, weave::loomlink::add_trust_commands,
                           weave::loomlink::add_signer_commands, weave::loomlink::add_loom_commands,
                           weave::loomlink::add_design_commands, weave::loomlink::add_step_commands,
                           weave::loomlink::add_evidence_commands, weave::loomlink::add_release_commands,
                           weave::loomlink::add_pull_command, weave::loomlink::add_verify_files_command,
                           weave::loomlink::add_log_commands, weave::loomlink::add_upkeep_commands})
        add(app, outcome);
    app.footer("'loomlink COMMAND --help' tells what a command takes.\n" + std::string(endings));
    try {
        app.parse(count, words);
    } catch (const CLI::ParseError& trouble) {
        if (trouble.get_exit_code() == 0) {
            app.exit(trouble);  // tells what --help and --version ask for
        } else {
            outcome.json = asks_for_json(count, words);  // which the parser need not have reached
            outcome.fail({weave::ErrorCode::usage, weave::loomlink::usage_trouble(app, trouble), ""});
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
        return weave::exit_code_of(weave::ErrorCode::system);
    }
    return outcome.exit_code;
}
