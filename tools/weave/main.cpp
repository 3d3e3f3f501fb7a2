// The command-line program `weave`: from slices, presets, card images and WIF to one validated card image.

#include "command.hpp"

#include <csignal>
#include <iostream>
#include <new>

namespace {

constexpr const char* about =
    "Designs and checks 3D woven cloth, from blocks to the card image that a Jacquard loom weaves.\n"
    "Ends count from the left and picks from the bottom, both from 1. A black pixel is a lifted end.\n";

constexpr const char* endings =
    "Exit status: 0 done, 1 findings or a refusal by validation, 2 usage, 3 bad input, 4 refused, 5 a fault "
    "of the system.";

}  // namespace

int main(int count, char** words) {
    std::signal(SIGXFSZ, SIG_IGN);  // a file past the limit is an error to tell and tidy up after, not our end
    weave::program::Program program;
    CLI::App app(about, "weave");
    app.set_version_flag("--version", "weave " WEAVE_VERSION);
    app.require_subcommand(1);
    app.footer(endings);
    weave::program::add_make_commands(app, program);
    weave::program::add_import_command(app, program);
    weave::program::add_look_commands(app, program);
    weave::program::add_loom_commands(app, program);
    try {
        app.parse(count, words);
    } catch (const CLI::ParseError& trouble) {
        if (trouble.get_exit_code() == 0) return app.exit(trouble);  // --help, --version
        std::cerr << "weave: " << trouble.what() << "\nTry 'weave --help' or 'weave COMMAND --help'.\n";
        return weave::program::usage;
    } catch (const std::bad_alloc&) {
        std::cerr << "weave: this machine has not enough memory for it\n";
        return weave::program::fault;
    } catch (const std::exception& trouble) {
        std::cerr << "weave: " << trouble.what() << '\n';
        return weave::program::fault;
    }
    std::cout.flush();
    if (!std::cout) {
        std::cerr << "weave: cannot write the answer to standard output\n";
        return weave::program::fault;
    }
    return program.exit_code;
}
