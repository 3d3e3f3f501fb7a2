// Relaxing a design into cloth, and looking at the result.

#include "command.hpp"
#include "interrupt.hpp"
#include "remote_job.hpp"
#include "simulate_ending.hpp"
#include "simulate_on.hpp"
#include "simulate_together.hpp"
#include "simulate_words.hpp"
#include "simulate_wish.hpp"
#include "sweep.hpp"
#include "teller.hpp"

#include <weave/core/file.hpp>
#include <weave/core/sha256.hpp>
#include <weave/core/text.hpp>
#include <weave/design/document.hpp>
#include <weave/ranks/mpi/mpi_comm.hpp>
#include <weave/sim/exports.hpp>
#include <weave/sim/forecast.hpp>
#include <weave/sim/memory_room.hpp>
#include <weave/sim/run.hpp>
#include <weave/sim/simulate.hpp>
#include <weave/sim/starts.hpp>
#include <weave/sim/symmetry.hpp>
#include <weave/sim/yarns_file.hpp>
#include <weave/wire/server_room.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

namespace weave::program {

namespace {

/// The state to go on from, out of a .yarns file.
Result<sim::StartState> taken_up(const std::string& file, const sim::Plan& plan, const SimulateTask& task) {
    WEAVE_TRY(const Yarns yarns, load_yarns(file));
    auto start = sim::start_from(plan, yarns, design_sha256(task.design), {scene_sha256(task.design), task.file_scene_sha256});
    if (!start) return std::move(start).error().in(file);
    return start;
}

/// The ending that leaves nothing for the whole cloth after its smallest repeat; empty where it goes on.
std::string over_after(const Json& report, const sim::SimulationOptions& options) {
    const std::string ending = report.at("ending");
    if (interrupted()) return "stopped";
    if (report.contains("goes_on") || ending == "stopped" || ending == "time") return ending;
    if (report.at("seconds").get<double>() >= options.most_seconds) return "time";
    return report.at("iterations").get<std::size_t>() >= options.most_iterations ? "iterations" : "";
}

/// The report of the whole cloth counts what its smallest repeat took, and says in which points that began.
void count_both(Json& whole, const Json& repeat) {
    for (const char* name : {"iterations", "evaluations"}) whole[name] = whole.at(name).get<std::size_t>() + repeat.at(name).get<std::size_t>();
    whole["seconds"] = whole.at("seconds").get<double>() + repeat.at("seconds").get<double>();
    if (repeat.contains("coarser")) whole["coarser"] = repeat.at("coarser");
}

/// Relaxes; with flips first the smallest repeat, then from there the whole cloth, one of whose crossings is to change.
Result<Yarns> relaxed(const Block& block, SimulateTask& task, const sim::Plan& plan, const SimulateWish& wish) {
    sim::SimulationOptions& options = task.options;
    if (!wish.resume.empty()) {
        WEAVE_TRY(options.start, taken_up(wish.resume, plan, task));
    }
    const bool reduced = plan.repeats[0] * plan.repeats[1] > 1;
    if (task.flips.empty() || !reduced) {
        options.flips = task.flips;
        return sim::simulate(task.design, plan, options);
    }
    Yarns repeat = sim::simulate(task.design, plan, options);
    if (const std::string over = over_after(repeat.report, options); !over.empty()) {
        repeat.report["flips"] = sim::flips_not_begun(task.flips, over);
        return repeat;
    }
    options.coarser = nullptr;
    options.most_iterations -= repeat.report.at("iterations").get<std::size_t>();
    options.most_seconds -= repeat.report.at("seconds").get<double>();
    sim::SimulationRequest request = task.request;
    request.reduce = false;
    WEAVE_TRY(const sim::Plan whole, plan_of(task.design, block, request, wish.file));
    WEAVE_TRY(options.start, sim::start_from(whole, repeat, repeat.design_sha256, {repeat.scene_sha256}));
    options.flips = task.flips;
    Yarns yarns = sim::simulate(task.design, whole, options);
    count_both(yarns.report, repeat.report);
    return yarns;
}

/// The smallest repeat, then the whole from a start with noise: the first of them, or with --whole the second, with what
/// both together tell.
Result<Yarns> compared_with_whole(const Block& block, const SimulateTask& task, const SimulateWish& wish, Teller& teller) {
    sim::SimulationRequest request = task.request;
    request.reduce = true;
    WEAVE_TRY(const sim::Plan reduced, plan_of(task.design, block, request, wish.file));
    if (reduced.repeats[0] * reduced.repeats[1] == 1)
        return usage_error("this cloth is simulated as one repeat: there are no others to compare it with", "--symmetry");
    request.reduce = false;
    WEAVE_TRY(const sim::Plan whole, plan_of(task.design, block, request, wish.file));
    Yarns repeat = sim::simulate(task.design, reduced, task.options);
    if (interrupted()) return repeat;
    teller.turn_to(" the whole cloth");
    sim::WholeRun run = sim::relaxed_whole(task.design, reduced, whole, task.options, repeat, wish.seed.value_or(1));
    const bool stopped = run.yarns.report.at("ending") == "stopped";
    Yarns yarns = wish.whole ? std::move(run.yarns) : std::move(repeat);
    if (!stopped) yarns.report["symmetry"] = std::move(run.symmetry);
    return yarns;
}

/// The yarns of one run, with what further runs tell.
Result<Yarns> simulated(const Block& block, SimulateTask& task, const sim::Plan& plan, const SimulateWish& wish, Teller& teller) {
    WEAVE_TRY(Yarns yarns, wish.symmetry ? compared_with_whole(block, task, wish, teller) : relaxed(block, task, plan, wish));
    teller.turn_to(" from other starts");
    if (wish.starts > 0 && !interrupted())
        yarns.report["starts"] = sim::relaxed_again(task.design, plan, task.options, yarns, wish.starts, wish.seed.value_or(1));
    return yarns;
}

/// What the coarser yarns say of themselves while they stand for the finer ones to come.
Status show_coarser(const Yarns& yarns, const std::string& file) {
    WEAVE_TRY(const std::string bytes, write_yarns(yarns));
    return write_file(file, bytes);
}

/// Lets the run begin in the points of another fidelity. The file has its yarns as soon as these are at rest.
Status start_coarser(const Block& block, SimulateTask& task, const sim::Plan& plan, const SimulateWish& wish, Teller& teller, Status& shown) {
    const std::string start_from = first_points(wish);
    if (start_from.empty()) return {};
    WEAVE_TRY(const sim::Fidelity rough, sim::parse_fidelity(start_from));
    WEAVE_TRY(task.coarser, plan_of(task.design, block, sim::coarser_request(task.request, rough), wish.file));
    if (task.coarser->points_per_key >= plan.points_per_key)
        return usage_error("has no fewer points than what is asked for", "--start-from " + start_from);
    task.options.coarser = &*task.coarser;
    const double goal = wish.residual.value_or(plan.goal);
    teller.turn_to(" in the points of " + start_from, task.coarser->goal);
    task.options.after_coarser = [&, goal](const Yarns& yarns) {
        teller.turn_to(" in all points", goal);
        shown = show_coarser(yarns, wish.out);
        return shown && !interrupted();
    };
    return {};
}

/// The same while a person is told how far it has come, and may end it.
Result<Yarns> watched(const Block& block, SimulateTask& task, const sim::Plan& plan, const SimulateWish& wish) {
    Teller teller(wish.residual.value_or(plan.goal));
    task.options.watch = [&](const sim::Progress& progress) { return teller(progress); };
    Status shown;
    WEAVE_CHECK_OK(start_coarser(block, task, plan, wish, teller, shown));
    WEAVE_TRY(Yarns yarns, simulated(block, task, plan, wish, teller));
    WEAVE_CHECK_OK(shown);
    teller.end();
    const std::vector<std::string> undone = left_undone(yarns.report, {task.flips.size(), wish.starts, wish.symmetry});
    if (!undone.empty()) yarns.report["left_undone"] = undone;
    if (!undone.empty() && interrupted()) yarns.report["interrupted"] = true;
    return yarns;
}

/// All runs are understood, and one is planned, before the first is handed over: what a server would refuse is known then.
Status sweep(CommandOutcome& outcome, wire::Follower& server, const Cloth& cloth, const SimulateWish& wish) {
    WEAVE_TRY(const auto settings, runs_of_sweep(wish.sweep));
    std::vector<SimulateTask> tasks;
    for (const auto& run : settings) {
        SimulateWish one = wish;
        one.set.insert(one.set.end(), run.begin(), run.end());
        auto task = understand(cloth, one);
        if (!task) {
            Error error = std::move(task).error();
            if (error.where.starts_with("--set ") && std::ranges::find(wish.set, error.where.substr(6)) == wish.set.end()) error.where.replace(0, 5, "--sweep");
            return std::move(error).in(wish.file);
        }
        tasks.push_back(std::move(*task));
    }
    WEAVE_TRY(const sim::Plan plan, plan_of(tasks.front().design, *cloth.evaluation.block, tasks.front().request, wish.file));
    if (tasks.front().request.region) WEAVE_CHECK_OK(check_flips_within(plan, tasks.front().flips));
    return sweep_on(outcome, server, tasks, settings, wish);
}

/// Where it is computed; nothing where that is not told: a server says itself what has no room there, later.
std::optional<sim::MemoryRoom> room_for(const std::optional<wire::Follower>& server) {
    if (!server) return sim::room_here();
    Result<sim::MemoryRoom> room = wire::room_on(server->place());
    return room ? std::optional(std::move(*room)) : std::nullopt;
}

/// The memory of a point is known within a factor of two (sim/forecast.hpp). What is not expected to have room is refused rather than tried:
/// the system ends a program that takes too much without a word.
Status check_memory(const sim::MemoryNeed& need, const std::optional<sim::MemoryRoom>& room, const std::string& file) {
    if (!room) return {};
    Status enough = sim::check_room(need, *room);
    if (!enough) return std::move(enough).error().in(file);
    return {};
}

/// What has no room is refused before it is laid out, which takes a minute and gigabytes.
Status foresee_memory(const SimulateTask& task, const Block& block, const std::optional<sim::MemoryRoom>& room, const std::string& file) {
    if (!room) return {};
    const std::optional<sim::MemoryNeed> need = sim::foreseen_need(task.design, block, task.request);
    return need ? check_memory(*need, room, file) : Status();
}

Status explain(CommandOutcome& outcome, const sim::Plan& plan) {
    const std::size_t points = sim::points_of(plan);
    const std::uint64_t bytes = sim::expected_bytes(plan), copies = sim::copied_bytes(plan);
    outcome.answer({{"plan", sim::lines_json(plan)}, {"yarns", plan.scene.yarns.size()}, {"points", points}, {"expected_bytes", bytes}},
                   in_words(plan.lines) + "points: " + std::to_string(points) + " (" + counted(plan.scene.yarns.size(), "yarn") + ", about " + sim::memory_text(bytes) +
                       " of memory" +
                       (copies > 0 ? ", " + sim::memory_text(copies) + " of it for all repeats and their file)\n" : " while they relax)\n"));
    return {};
}

Status run_simulation(CommandOutcome& outcome, const SimulateWish& wish) {
    if (ranks::is_one_of_many()) return simulate_together(outcome, wish);
    WEAVE_CHECK_OK(check_alone(wish));
    WEAVE_CHECK_OK(check_wish(wish));
    std::optional<wire::Follower> server;
    if (!wish.server.host.empty()) {
        WEAVE_TRY(const wire::ServerPlace place, place_of(wish.server));
        WEAVE_TRY(server, connected(place));
        if (!wish.evidence.empty()) {
            if (Status signs = wire::check_signs(*server); !signs) {
                Error error = std::move(signs).error();
                error.message += " (--evidence)";
                return error;
            }
        }
    }
    WEAVE_TRY(const Cloth cloth, load_cloth(outcome, wish.file));
    const Block& block = *cloth.evaluation.block;
    if (!wish.sweep.empty()) return sweep(outcome, *server, cloth, wish);
    auto understood = understand(cloth, wish);
    if (!understood) return std::move(understood).error().in(wish.file);
    SimulateTask& task = *understood;
    const std::optional<sim::MemoryRoom> room = wish.explain ? std::nullopt : room_for(server);
    WEAVE_CHECK_OK(foresee_memory(task, block, room, wish.file));
    WEAVE_TRY(sim::Plan plan, plan_of(task.design, block, task.request, wish.file));
    if (!server) {
        const Result<sim::BackendChoice> choice = sim::choose_backend(task.options.backend, plan.scene);
        if (!choice) return Error{choice.error().code, choice.error().message, "--backend " + wish.backend};
        plan.lines.push_back({"backend", choice->device.empty() ? "cpu" : "cuda: " + choice->device, choice->reason});
    }
    if (wish.explain) {
        return explain(outcome, plan);
    }
    if (task.request.region) {
        WEAVE_CHECK_OK(check_flips_within(plan, task.flips));
    }
    WEAVE_CHECK_OK(check_memory(sim::need_of(plan), room, wish.file));
    if (server) {  // which plans by itself; what it would refuse is known now, and not after its queue
        const double goal = wish.residual.value_or(plan.goal);
        plan = {};
        return simulate_on(outcome, *server, cloth.design, task, wish, goal);
    }
    const HeldInterrupt held("the yarns are written as they lie; again to end at once, without the state");
    WEAVE_TRY(const Yarns yarns, watched(block, task, plan, wish));
    WEAVE_TRY(const std::string bytes, write_yarns(yarns));
    WEAVE_CHECK_OK(write_file(wish.out, bytes));
    Json answer = yarns.report;
    answer["file"] = wish.out;
    answer["yarns_sha256"] = sha256_hex(bytes);
    return tell_ending(outcome, yarns.report, std::move(answer), {cloth.design, task.flips, wish.save_design});
}

void add_simulate(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command = add_command(app, outcome, "simulate",
                                    "Relax a design into real cloth: where its yarns come to rest (exit 1: not at rest, or a "
                                    "crossing changed)");
    const auto wish = std::make_shared<SimulateWish>();
    command->add_option("FILE", wish->file, "the .weave file")->required();
    command->add_option("-o,--out", wish->out, "the .yarns file to write")->type_name("FILE");
    command->add_option("--fidelity", wish->fidelity, "draft, standard (if nothing is said) or reference")->type_name("WORD");
    command->add_option("--solver", wish->solver, "relax (if nothing is said), or paper: in time as the paper did, the slow baseline")
        ->type_name("WORD");
    command->add_option("--points", wish->points, "control points for each crossing, instead of the fidelity's")->check(positive_number())->type_name("N");
    command->add_option("--residual", wish->residual, "how still is still: greatest force over the reference force, 1e-15 to 1 (below some 1e-12 rounding lets no cloth come to rest)")
        ->check(residual_goal())
        ->type_name("N");
    command->add_option("--set", wish->set, "a number of the scene for this run, such as warp.strain=1.02 or friction=0.2")->type_name("NAME=N");
    CLI::Option* sweeping = command->add_option("--sweep", wish->sweep, "with --on: a job for each of these numbers of the scene, and for each combination where it is given again; "
                                                                        "their numbers are told, and weave jobs fetch gets what came of each")
                                ->type_name("NAME=N,N,…")
                                ->allow_extra_args(false);
    command->add_option("--backend", wish->backend, "what computes: auto (if nothing is said: a CUDA device where there is one that can, else the processor), cpu or cuda (weave devices "
                                                    "lists them); a server has its own")->type_name("WORD");
    command->add_option("--boundary", wish->boundaries, "the rim for this run: x= or y= with periodic, frozen, free or relaxing:FORCE")
        ->type_name("RIM")
        ->allow_extra_args(false);
    command->add_option("--pin", wish->pins, "hold a yarn or a crossing where it is planned: pick:N, end:N or PICK,END")
        ->type_name("YARN")
        ->allow_extra_args(false);
    command->add_option("--field", wish->fields, "a sphere that pushes yarns out: sphere:X,Y,Z,RADIUS,STRENGTH; none: no sphere of the scene")
        ->type_name("FIELD")
        ->allow_extra_args(false);
    command->add_option("--flip", wish->flips, "let a pick and an end change sides in the relaxed cloth")->type_name("PICK,END")->allow_extra_args(false);
    command->add_option("--save-design", wish->save_design, "the .weave file to write with the flips that were made, if any was")->type_name("FILE");
    command->add_option("--resume", wish->resume, "go on from these relaxed yarns of the same design")->type_name("FILE");
    command->add_option("--start-from", wish->start_from, "relax in the fewer points of this fidelity first, such as draft, or at once: plan; reference "
                                                          "begins at standard if nothing is said. The file has these yarns, so "
                                                          "marked, until the others are at rest")
        ->type_name("WORD");
    command->add_option("--region", wish->region, "only a part, with frozen rims: picks:1-40,ends:1-60")->type_name("PART");
    command->add_flag("--wraparound", wish->wraparound, "the picks of a feeder are one yarn that turns at the edges");
    command->add_flag("--whole", wish->whole, "do not reduce a periodic cloth to its smallest repeat");
    command->add_option("--starts", wish->starts, "relax so many times more from starts with noise, and tell how much the result owes to its start")
        ->transform(between(1, 1000))
        ->type_name("N");
    command->add_flag("--symmetry", wish->symmetry, "relax the whole cloth too, from a start with noise, and tell whether its repeats lie alike "
                                                    "(with --whole its yarns are written)");
    command->add_option("--seed", wish->seed, "of that noise; 1 if nothing is said")->transform(whole_number())->type_name("N");
    command->add_flag("--explain", wish->explain, "tell what would be simulated and why, and end");
    command->add_option("--steps", wish->steps, "stop after so many steps in all; each run of --starts and --symmetry has as many")->transform(whole_number())->type_name("N");
    command->add_option("--seconds", wish->seconds, "stop after so long in all; each run of --starts and --symmetry has as long, and so has each that goes on from a checkpoint")->check(positive_number())->type_name("N");
    add_threads(command, wish->threads);
    command->add_option("--checkpoint", wish->checkpoint, "under mpirun: the folder for checkpoints, which all processes see; where it has one of this run, that is gone on "
                                                          "from, with any number of processes")
        ->check([](const std::string& folder) { return folder.empty() ? "is empty" : ""; })
        ->type_name("FOLDER");
    command->add_option("--checkpoint-every", wish->checkpoint_every, "seconds between checkpoints; 120 if nothing is said")->check(positive_number())->type_name("N");
    command->add_option("--patience", wish->patience, "under mpirun: seconds after which processes that do not answer are lost; 600 if nothing is said")
        ->transform(between(1, 1'000'000))
        ->type_name("N");
    CLI::Option* on = add_server_options(command, wish->server);
    sweeping->needs(on);
    command->add_option("--evidence", wish->evidence, "the file for what the server signs of the result, for loomlink")->needs(on)->type_name("FILE");
    command->footer("Ctrl-C writes the yarns as they lie (exit 1), for --resume to go on from; again, half a second later or more, ends at "
                    "once without them.\nWith --on the file is written once, at the end; Ctrl-C cancels the job and writes its yarns as they lay. weave jobs "
                    "lists what is on the server.\nUnder mpirun (mpirun -n 4 weave simulate …) the processes relax one cloth together (docs/scale.md); the signal USR1 to mpirun then "
                    "writes the yarns as they lie.\n" + command->get_footer());
    on_run(command, outcome, [=, &outcome] {
        wish->no_plan_option = given_of(command, {"--out", "--sweep", "--solver", "--residual", "--flip", "--save-design", "--resume", "--start-from", "--starts",
                                                  "--symmetry", "--seed", "--steps", "--seconds", "--threads", "--checkpoint", "--checkpoint-every", "--patience", "--on"});
        wish->no_server_option = given_of(command, {"--resume", "--starts", "--symmetry", "--seed", "--threads", "--checkpoint", "--checkpoint-every", "--patience"});
        return run_simulation(outcome, *wish);
    });
}

struct YarnsExport {
    std::string file, out;
};

Status export_yarns(CommandOutcome& outcome, const YarnsExport& wish) {
    const std::string extension = lower_extension(wish.out);
    if (extension != ".vtp" && extension != ".obj") return usage_error("yarns are exported as .vtp or .obj", wish.out);
    WEAVE_CHECK_OK(keep_apart(wish.out, wish.file, "the file of yarns that is read"));
    WEAVE_TRY(const Yarns yarns, load_yarns(wish.file));
    WEAVE_TRY(const std::string bytes, extension == ".vtp" ? write_vtp(yarns) : write_obj(yarns));
    WEAVE_CHECK_OK(write_file(wish.out, bytes));
    outcome.answer({{"file", wish.out}, {"yarns", yarns.yarns.size()}, {"bytes", bytes.size()}},
                   on_one_line(wish.out) + ": " + counted(yarns.yarns.size(), "yarn") + "\n");
    return {};
}

void add_yarns_export(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command = add_command(app, outcome, "export-yarns", "Write relaxed yarns for other programs: .vtp (ParaView) or .obj");
    const auto wish = std::make_shared<YarnsExport>();
    command->add_option("FILE", wish->file, "the .yarns file")->required();
    command->add_option("-o,--out", wish->out, "the file to write: .vtp or .obj")->type_name("FILE")->required();
    on_run(command, outcome, [=, &outcome] { return export_yarns(outcome, *wish); });
}

}  // namespace

Result<Yarns> load_yarns(const std::string& file) {
    WEAVE_TRY(const std::string bytes, read_file(file, std::uint64_t{8} << 30));
    Result<Yarns> yarns = read_yarns(bytes);
    if (!yarns) return std::move(yarns).error().in(file);
    return yarns;
}

void add_simulation_commands(CLI::App& app, CommandOutcome& outcome) {
    add_simulate(app, outcome);
    add_yarns_export(app, outcome);
}

}  // namespace weave::program
