#include "simulate_together.hpp"

#include "interrupt.hpp"
#include "progress.hpp"
#include "simulate_ending.hpp"
#include "simulate_words.hpp"
#include "teller.hpp"

#include <weave/core/descriptor.hpp>
#include <weave/core/sha256.hpp>
#include <weave/core/text.hpp>
#include <weave/ranks/mpi/mpi_comm.hpp>
#include <weave/ranks/split_run.hpp>
#include <weave/sim/forecast.hpp>

#include <algorithm>
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
std::string last_words(const std::string& folder, std::optional<std::size_t> newest) {
    if (folder.empty()) return "ended from outside, and no checkpoints were asked for (--checkpoint FOLDER): nothing is kept";
    // A checkpoint may have become whole just now: only its folder knows.
    const std::string known = newest ? "the checkpoint of step " + std::to_string(*newest) + " in " + folder + " is whole" : "no checkpoint in " + folder + " was known to be whole yet";
    return "ended from outside; " + known + ": the same command goes on from the newest that is" + (newest ? "" : ", or begins anew") + ", with any number of processes";
}

}  // namespace

void let_one_speak() {
    if (ranks::is_one_of_many() && !is_first_process()) be_silent();
}

Status check_alone(const SimulateWish& wish) {
    if (!wish.checkpoint.empty()) return usage_error("is of processes that relax one cloth together: mpirun -n 1 weave simulate … writes them too", "--checkpoint");
    if (wish.checkpoint_every) return usage_error("is of processes that relax one cloth together, by mpirun", "--checkpoint-every");
    if (wish.patience) return usage_error("is of processes that relax one cloth together, by mpirun", "--patience");
    return {};
}

namespace {

/// What several processes do not do.
Status check_together(const SimulateWish& wish) {
    for (const auto& [is_given, name] : {std::pair{!wish.server.host.empty(), "--on"}, std::pair{!wish.flips.empty(), "--flip"}, std::pair{!wish.resume.empty(), "--resume"},
                                         std::pair{!wish.start_from.empty() && wish.start_from != "plan", "--start-from"}, std::pair{wish.starts > 0, "--starts"},
                                         std::pair{wish.symmetry, "--symmetry"}, std::pair{wish.solver != "relax", "--solver"}, std::pair{wish.backend == "cuda", "--backend cuda"}})
        if (is_given) return usage_error("is not computed by several processes together: run it without mpirun", name);
    return {};
}

/// The plan looks at the design and its block, which therefore stay where they are.
struct Prepared {
    std::unique_ptr<const Design> design;
    BlockPtr block;
    sim::PlanInStretches plan;
};

Result<Prepared> prepare(CommandOutcome& outcome, const SimulateWish& wish) {
    WEAVE_CHECK_OK(check_together(wish));
    WEAVE_CHECK_OK(check_wish(wish));
    WEAVE_TRY(const Cloth cloth, load_cloth(outcome, wish.file));
    auto task = understand(cloth, wish);
    if (!task) return std::move(task).error().in(wish.file);
    Prepared prepared{std::make_unique<const Design>(std::move(task->design)), cloth.evaluation.block, {}};
    const Progress progress("planning " + wish.file);
    auto plan = sim::PlanInStretches::make(*prepared.design, *prepared.block, task->request);
    if (!plan) return std::move(plan).error().in(wish.file);
    prepared.plan = *std::move(plan);
    return prepared;
}

/// The processes, until the program ends: mpirun ends all once one of them has, and the first shall have told what is wrong.
Result<ranks::Comm*> others(const SimulateWish& wish) {
    static std::unique_ptr<ranks::Comm> comm;
    WEAVE_TRY(comm, ranks::join_others(std::chrono::seconds(wish.patience.value_or(usual_patience_s)), say));
    return comm.get();
}

ranks::SplitOptions options_of(const ranks::Comm& comm, const SimulateWish& wish, Teller& teller) {
    ranks::SplitOptions options;
    options.residual = wish.residual;
    options.most_iterations = wish.steps.value_or(options.most_iterations);
    options.most_seconds = wish.seconds.value_or(options.most_seconds);
    options.threads = wish.threads > 0 ? wish.threads : 1;
    options.checkpoints = wish.checkpoint;
    options.checkpoint_every_s = wish.checkpoint_every.value_or(options.checkpoint_every_s);
    options.watch = [&](const sim::Progress& progress) { return (!comm.is_first() || teller(progress)) && !asked_to_stop(); };
    options.note = [&](const std::string& line) { teller.note(line); };
    options.saved = [&](std::size_t step) { tell_when_ended(last_words(wish.checkpoint, step)); };
    return options;
}

/// What the run would be, and how it would be shared.
Status explain(CommandOutcome& outcome, ranks::Comm& comm, const Prepared& prepared) {
    WEAVE_TRY(Json answer, ranks::explain_split(comm, *prepared.design, prepared.plan));
    const sim::Plan& plan = prepared.plan.plan();
    std::string text = in_words(plan.lines);
    text += "  blocks: " + std::to_string(answer.at("blocks").at("rows").get<std::size_t>()) + " x " + std::to_string(answer.at("blocks").at("columns").get<std::size_t>()) +
            " (" + counted(answer.at("points").get<std::size_t>(), "control point") + ")\n";
    for (std::size_t rank = 0; rank < comm.size(); ++rank) {
        const Json& one = answer.at("ranks").at(rank);
        text += "  process " + std::to_string(rank + 1) + ": " + counted(one.at("blocks").get<std::size_t>(), "block") + " with " +
                counted(one.at("points").get<std::size_t>(), "point") + " (planning took " + sim::memory_text(one.at("peak_bytes").get<std::uint64_t>()) + ")\n";
    }
    answer["plan"] = sim::lines_json(plan);
    answer["yarns"] = plan.scene.yarns.size();
    outcome.answer(std::move(answer), text);
    return {};
}

Status tell(CommandOutcome& outcome, const ranks::Comm& comm, const Design& design, Json report, const SimulateWish& wish) {
    const std::vector<std::string> undone = left_undone(report, {0, 0, false});
    if (!undone.empty()) report["left_undone"] = undone;
    if (!undone.empty() && asked_to_stop()) report["interrupted"] = true;
    Json answer = report;
    answer["file"] = wish.out;
    if (comm.is_first()) {
        WEAVE_TRY(answer["yarns_sha256"], hash_of_file(wish.out));
    }
    return tell_ending(outcome, report, std::move(answer), {design, {}, {}});
}

}  // namespace

Status simulate_together(CommandOutcome& outcome, const SimulateWish& wish) {
    WEAVE_TRY(ranks::Comm* const comm, others(wish));
    Result<Prepared> prepared = prepare(outcome, wish);
    WEAVE_CHECK_OK(ranks::agreed(*comm, prepared ? Status() : Status(prepared.error())));
    if (wish.explain) return explain(outcome, *comm, *prepared);
    tell_when_ended(comm->is_first() ? last_words(wish.checkpoint, {}) : "");
    stop_on_user_signal();
    Teller teller(wish.residual.value_or(prepared->plan.plan().goal));
    const Result<Json> report = ranks::simulate_split(*comm, *prepared->design, std::move(prepared->plan), options_of(*comm, wish, teller), wish.out);
    tell_when_ended("");
    if (!report) return report.error();
    teller.end();
    return tell(outcome, *comm, *prepared->design, *report, wish);
}

}  // namespace weave::program
