// The command-line program `weave`: from slices, presets, card images and WIF to one validated card image.

#include "command.hpp"
#include "interrupt.hpp"

#include <weave/core/log.hpp>
#include <weave/core/text.hpp>

#include <algorithm>
#include <csignal>
#include <iostream>
#include <new>
#include <string>
#include <string_view>
#include <vector>

namespace {

constexpr const char* about =
    "Designs and checks 3D woven cloth, from blocks to the card image that a Jacquard loom weaves.\n"
    "Ends count from the left and picks from the bottom, both from 1. A black pixel is a lifted end.\n";

constexpr const char* endings =
    "Exit status: 0 done, 1 findings or a refusal by validation, 2 usage, 3 bad input, 4 refused, 5 a fault "
    "of the system.";

/// What is wrong with a call, in a sentence. CLI11 asks for a command before it looks at words it does not
/// know.
std::string usage_trouble(const CLI::App& app, const CLI::ParseError& trouble) {
    if (!app.get_subcommands().empty()) return trouble.what();
    const std::vector<std::string> unknown = app.remaining();
    if (unknown.empty()) return "name a command";
    const bool option = unknown.front().rfind('-', 0) == 0;
    return "there is no " + std::string(option ? "option" : "command") + " '" + unknown.front() + "'";
}

bool asks_for_json(int count, char** words) {
    return std::any_of(words + 1, words + count,
                       [](const char* word) { return std::string(word) == "--json"; });
}

/// What the library tells besides its results, such as a file's other name that keeps the old content.
void tell(weave::LogLevel level, std::string_view message) {
    if (level != weave::LogLevel::debug) std::cerr << "weave: " << weave::on_one_line(message) << '\n';
}

}  // namespace

int main(int count, char** words) {
    std::signal(SIGXFSZ,
                SIG_IGN);  // a file past the limit is an error to tell and tidy up after, not our end
    weave::program::tidy_up_when_ended();
    weave::set_log_sink(tell);
    weave::program::Program program;
    CLI::App app(about, "weave");
    app.get_formatter()->label("SUBCOMMAND", "COMMAND ...");
    app.get_formatter()->label("TEXT", "");  // what a word stands for says more than that it is text
    app.set_help_flag("-h,--help", "tell this and end");
    app.set_version_flag("--version", "weave " WEAVE_VERSION, "tell the version and end");
    app.require_subcommand(1);
    app.footer(endings);  // which the commands inherit
    weave::program::add_make_commands(app, program);
    weave::program::add_import_command(app, program);
    weave::program::add_look_commands(app, program);
    weave::program::add_diff_command(app, program);
    weave::program::add_loom_commands(app, program);
    weave::program::add_simulation_commands(app, program);
    weave::program::add_inspection_commands(app, program);
    weave::program::add_bench_commands(app, program);
    app.footer("'weave COMMAND --help' tells what a command takes.\n" + std::string(endings));
    try {
        app.parse(count, words);
    } catch (const CLI::ParseError& trouble) {
        if (trouble.get_exit_code() == 0) {
            app.exit(trouble);  // tells what --help and --version ask for
        } else {
            program.json = asks_for_json(count, words);  // which the parser need not have reached
            program.fail({weave::ErrorCode::usage, usage_trouble(app, trouble), ""});
            std::cerr << "Try 'weave --help' or 'weave COMMAND --help'.\n";
        }
    } catch (const std::bad_alloc&) {
        program.fail(weave::system_fault("this machine has not enough memory for it"));
    } catch (const std::exception& trouble) {
        program.fail(weave::system_fault(trouble.what()));
    }
    std::cout.flush();
    if (!std::cout) {
        std::cerr << "weave: cannot write the answer to standard output\n";
        return weave::program::fault;
    }
    return program.exit_code;
}
