// The command-line program `weave`: from slices, presets, card images and WIF to one validated card image.

#include "command.hpp"
#include "interrupt.hpp"
#include "simulate_together.hpp"

namespace {

constexpr const char* about =
    "Designs and checks 3D woven cloth, from blocks to the card image that a Jacquard loom weaves.\n"
    "Ends count from the left and picks from the bottom, both from 1. A black pixel is a lifted end.\n";

}  // namespace

int main(int count, char** words) {
    weave::program::tidy_up_when_ended();
    weave::program::let_one_speak();
    weave::CommandOutcome outcome("weave", weave::JsonLayout::over_lines);
    CLI::App app(about, "weave");
    weave::prepare_program(app, WEAVE_VERSION);
    for (const auto add :
         {weave::program::add_make_commands, weave::program::add_import_command,
          weave::program::add_look_commands, weave::program::add_diff_command,
          weave::program::add_loom_commands, weave::program::add_simulation_commands,
          weave::program::add_inspection_commands, weave::program::add_job_commands, weave::program::add_session_commands,
          weave::program::add_bench_commands, weave::program::add_device_commands})
        add(app, outcome);
    return weave::run_program(app, outcome, count, words);
}
