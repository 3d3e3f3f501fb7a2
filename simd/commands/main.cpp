// The program `simd`: the simulation daemon, and what its owner does with it.

#include <weave/command/serving.hpp>

#include <simd/commands/command.hpp>
#include <simd/slurm/attempt.hpp>
#include <simd/worker/work.hpp>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace {

int tell_of_job() {
    std::puts(
        "Usage: simd job FILE\n\n"
        "Does one job of an array that a daemon handed to Slurm, on a node; nobody but Slurm starts it.\n"
        "FILE names the jobs of the array, SLURM_ARRAY_TASK_ID which of them is to be done.\n"
        "Exit status: 0 done, 75 to be tried again, 70 never.");
    return 0;
}

}  // namespace

int main(int count, char** words) {
    constexpr int link = 3;  // where the daemon that starts it has put it
    if (count == 2 && std::string_view(words[1]) == "worker") return weave::simd::work_for_daemon(link);
    if (count == 3 && std::string_view(words[1]) == "job") {  // Slurm starts it so, on a node
        if (std::string_view(words[2]) == "--help" || std::string_view(words[2]) == "-h") return tell_of_job();
        weave::log_to_stderr();
        return weave::simd::run_job_of_array(words[2]);
    }
    // `simd --config F` and `simd --check-config …` mean `serve`: other programs start it so.
    std::vector<char*> all(words, words + count);
    std::string serve = "serve";
    const std::string_view first = count > 1 ? words[1] : "";
    if (first.starts_with("--config") || first == "--check-config") all.insert(all.begin() + 1, serve.data());
    weave::CommandOutcome outcome("simd", weave::JsonLayout::on_one_line);
    CLI::App app("Simulates cloth for many people at once: live sessions, and jobs in a queue.\n", "simd");
    weave::prepare_program(app, WEAVE_VERSION);
    for (const auto add : {weave::simd::add_serve_command, weave::simd::add_token_commands, weave::simd::add_status_commands}) add(app, outcome);
    return weave::run_program(app, outcome, static_cast<int>(all.size()), all.data());
}
