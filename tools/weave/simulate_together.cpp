#include "simulate_together.hpp"

#include "interrupt.hpp"
#include "simulate_ending.hpp"
#include "teller.hpp"

#include <weave/core/descriptor.hpp>
#include <weave/core/sha256.hpp>
#include <weave/core/text.hpp>
#include <weave/ranks/mpi/mpi_comm.hpp>
#include <weave/ranks/split_run.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <memory>
#include <string_view>
#include <utility>

namespace weave::program {

namespace {

constexpr std::size_t usual_patience_s = 600;
int loud_errors = STDERR_FILENO;  ///< where a process that is silent tells what only it knows

bool is_first_process() {
    const char* const rank = std::getenv("OMPI_COMM_WORLD_RANK");
    return rank == nullptr || std::string_view(rank) == "0";
}

/// Whatever is wrong with the words or the design all find alike: one tells it.
void be_silent() {
    static bool done = false;
    if (std::exchange(done, true)) return;
    loud_errors = ::dup(STDERR_FILENO);
    const Descriptor nowhere(::open("/dev/null", O_WRONLY | O_CLOEXEC));
    if (nowhere.number() < 0) return;
    ::dup2(nowhere.number(), STDERR_FILENO);
    ::dup2(nowhere.number(), STDOUT_FILENO);
}

void say(const std::string& line) {
    ::dprintf(loud_errors, "weave: %s\n", on_one_line(line).c_str());
}

Result<std::string> hash_of_file(const std::string& file) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> open(std::fopen(file.c_str(), "rb"), &std::fclose);
    if (!open) return file_fault(file, "open");
    Sha256 hash;
    std::string piece(1 << 20, '\0');
    while (const std::size_t got = std::fread(piece.data(), 1, piece.size(), open.get())) hash.add(std::string_view(piece).substr(0, got));
    if (std::ferror(open.get()) != 0) return file_fault(file, "read");
    return hash.hex();
}

/// What is told where the run is ended from outside, as mpirun ends it when a process is gone.
std::string last_words(const std::string& folder, const std::string& saved) {
    if (folder.empty()) return "ended from outside, and no checkpoints were asked for (--checkpoint FOLDER): nothing is kept";
    return "ended from outside; " + (saved.empty() ? std::string("no checkpoint was written yet") : saved) +
           ": the same command goes on from there, with any number of processes";
}

}  // namespace

bool runs_together() {
    if (!ranks::is_one_of_many()) return false;
    if (!is_first_process()) be_silent();
    return true;
}

Status check_together(const SimulateWish& wish) {
    if (!runs_together()) {
        if (!wish.checkpoint.empty()) return usage_error("is of processes that relax one cloth together: mpirun -n 1 weave simulate … writes them too", "--checkpoint");
        if (wish.patience) return usage_error("is of processes that relax one cloth together, by mpirun", "--patience");
        return {};
    }
    for (const auto& [is_given, name] : {std::pair{!wish.server.host.empty(), "--on"}, std::pair{!wish.flips.empty(), "--flip"}, std::pair{!wish.resume.empty(), "--resume"},
                                         std::pair{!wish.start_from.empty() && wish.start_from != "plan", "--start-from"}, std::pair{wish.starts > 0, "--starts"},
                                         std::pair{wish.symmetry, "--symmetry"}, std::pair{wish.solver != "relax", "--solver"}, std::pair{wish.backend == "cuda", "--backend cuda"}})
        if (is_given) return usage_error("is not computed by several processes together: run it without mpirun", name);
    return {};
}

Status simulate_together(CommandOutcome& outcome, const Design& design, sim::Plan plan, const SimulateWish& wish) {
    tell_when_ended(is_first_process() ? last_words(wish.checkpoint, "") : "");
    WEAVE_TRY(const std::unique_ptr<ranks::Comm> comm, ranks::join_others(std::chrono::seconds(wish.patience.value_or(usual_patience_s)), say));
    stop_on_user_signal();
    Teller teller(wish.residual.value_or(plan.goal));
    ranks::SplitOptions options;
    options.residual = wish.residual;
    options.most_iterations = wish.steps.value_or(options.most_iterations);
    options.most_seconds = wish.seconds.value_or(options.most_seconds);
    options.threads = wish.threads > 0 ? wish.threads : 1;
    options.checkpoints = wish.checkpoint;
    options.checkpoint_every_s = wish.checkpoint_every.value_or(options.checkpoint_every_s);
    options.watch = [&](const sim::Progress& progress) { return (!comm->is_first() || teller(progress)) && !asked_to_stop(); };
    options.note = [&](const std::string& line) {
        teller.note(line);
        tell_when_ended(last_words(wish.checkpoint, "the newest: " + line));
    };
    const Result<Json> report = ranks::simulate_split(*comm, design, std::move(plan), options, wish.out);
    tell_when_ended("");
    if (!report) {
        if (!comm->is_first() && report.error().message.find("it tells why") == std::string::npos) say("rank " + std::to_string(comm->rank()) + ": " + report.error().text());
        return report.error();
    }
    teller.end();
    Json told = *report;
    const std::vector<std::string> undone = left_undone(told, {0, 0, false});
    if (!undone.empty()) told["left_undone"] = undone;
    if (!undone.empty() && asked_to_stop()) told["interrupted"] = true;
    Json answer = told;
    answer["file"] = wish.out;
    if (comm->is_first()) {
        WEAVE_TRY(answer["yarns_sha256"], hash_of_file(wish.out));
    }
    return tell_ending(outcome, told, std::move(answer), {design, {}, {}});
}

}  // namespace weave::program
