// The program `simd`: the simulation daemon, and what its owner does with it.

#include <simd/commands/command.hpp>
#include <simd/worker/work.hpp>
#include <string_view>

int main(int count, char** words) {
    constexpr int link = 3;  // where the daemon that starts it has put it
    if (count == 2 && std::string_view(words[1]) == "worker") return weave::simd::work_for_daemon(link);
    weave::CommandOutcome outcome("simd", weave::JsonLayout::on_one_line);
    CLI::App app("Simulates cloth for many people at once: live sessions, and jobs in a queue.\n", "simd");
    weave::prepare_program(app, WEAVE_VERSION);
    for (const auto add : {weave::simd::add_serve_command, weave::simd::add_token_commands, weave::simd::add_status_commands}) add(app, outcome);
    return weave::run_program(app, outcome, count, words);
}
