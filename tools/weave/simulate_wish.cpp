#include "simulate_wish.hpp"

#include "progress.hpp"
#include "simulate_words.hpp"

#include <weave/design/document.hpp>

#include <algorithm>
#include <utility>

namespace weave::program {

namespace {

/// Which one there is of those that may be asked for turns out with the plan. A server takes the one that it was set up for.
Status check_backend(const SimulateWish& wish) {
    const Result<sim::Backend> backend = sim::parse_backend(wish.backend);
    if (!backend) return usage_error(backend.error().message, "--backend " + wish.backend);
    if (*backend != sim::Backend::automatic && !wish.server.host.empty())
        return usage_error("cannot be had from a server (--on), which computes on what it was set up for: auto", "--backend " + wish.backend);
    if (*backend == sim::Backend::cuda && wish.solver == "paper")
        return usage_error("has the solver relax alone: paper is computed on the processor", "--backend cuda");
    return {};
}

/// What is read or written besides is not written over. Two files may change in place: yarns that are gone on from, and
/// the design that gets its flips.
Status check_files(const SimulateWish& wish) {
    WEAVE_CHECK_OK(keep_apart(wish.out, wish.file, "the design that is read"));
    WEAVE_CHECK_OK(keep_apart(wish.save_design, wish.out, "the file for the yarns (-o)"));
    for (const auto& [other, is] : {std::pair{wish.file, "the design that is read"}, std::pair{wish.out, "the file for the yarns (-o)"},
                                    std::pair{wish.save_design, "the design that is written"}})
        WEAVE_CHECK_OK(keep_apart(wish.evidence, other, is));
    WEAVE_CHECK_OK(keep_apart(wish.out, wish.server.token_file, "the file of the token"));
    WEAVE_CHECK_OK(keep_apart(wish.save_design, wish.resume, "the file of yarns that are gone on from"));
    WEAVE_CHECK_OK(check_kind(wish.out, ".yarns"));
    return check_kind(wish.save_design, ".weave");
}

}  // namespace

Error usage_error(std::string message, std::string where) {
    return {ErrorCode::usage, std::move(message), std::move(where)};
}

Status check_wish(const SimulateWish& wish) {
    if (!wish.server.host.empty() && !wish.no_server_option.empty())
        return usage_error("cannot be had from a server (--on): it computes alone, on what it has", wish.no_server_option);
    WEAVE_CHECK_OK(check_backend(wish));
    WEAVE_CHECK_OK(check_files(wish));
    if (!wish.sweep.empty() && (!wish.out.empty() || !wish.evidence.empty() || !wish.save_design.empty()))
        return usage_error("leaves its jobs to the server, and writes nothing: weave jobs fetch gets what came of each", "--sweep " + wish.sweep.front());
    if (!wish.explain && wish.out.empty() && wish.sweep.empty()) return usage_error("say where the yarns go: -o OUT.yarns", "");
    if (wish.explain && !wish.no_plan_option.empty())
        return usage_error("--explain only tells the plan, in which this option changes nothing", wish.no_plan_option);
    if (wish.seed && wish.starts == 0 && !wish.symmetry)
        return usage_error("is of the noise of --starts and --symmetry; without them there is none", "--seed");
    if (!wish.save_design.empty() && wish.flips.empty())
        return usage_error("without --flip the design stays as it is", "--save-design " + wish.save_design);
    if (!wish.flips.empty() && (wish.starts > 0 || wish.symmetry))
        return usage_error("what is looked at from other starts takes no flips", wish.symmetry ? "--symmetry" : "--starts");
    if (wish.symmetry && !wish.resume.empty())
        return usage_error("the smallest repeat and the whole begin at the same start: without --resume", "--symmetry");
    if (!wish.start_from.empty() && !wish.resume.empty())
        return usage_error("there is one start: without --resume", "--start-from " + wish.start_from);
    if (!wish.start_from.empty() && (wish.starts > 0 || wish.symmetry))
        return usage_error("what is looked at from other starts begins at the planned one", "--start-from " + wish.start_from);
    return check_outputs({wish.out, wish.evidence, wish.save_design});
}

namespace {

Status check_each_rim_once(const std::vector<std::string>& boundaries) {
    for (std::size_t k = 1; k < boundaries.size(); ++k) {
        const auto same_axis = [&](const std::string& other) { return other.substr(0, 2) == boundaries[k].substr(0, 2); };
        if (std::any_of(boundaries.begin(), boundaries.begin() + static_cast<std::ptrdiff_t>(k), same_axis))
            return usage_error("this rim is said twice", "--boundary " + boundaries[k]);
    }
    return {};
}

}  // namespace

Result<SimulateTask> understand(Cloth cloth, const SimulateWish& wish) {
    const Block& block = *cloth.evaluation.block;
    SimulateTask task;
    task.file_scene_sha256 = scene_sha256(cloth.design);
    task.design = std::move(cloth.design);
    Scene& scene = task.design.scene;
    WEAVE_TRY(task.request.fidelity, sim::parse_fidelity(wish.fidelity));
    WEAVE_TRY(task.options.solver, sim::parse_solver(wish.solver));
    // The design is sound as the file has it: what is wrong with it afterwards came by the option.
    const auto apply = [&](const char* option, const std::vector<std::string>& texts, const auto& change) -> Status {
        for (const std::string& text : texts) {
            WEAVE_CHECK_OK(change(text));
            if (const Status sound = check(task.design); !sound) return usage_error(sound.error().message, std::string(option) + " " + text);
        }
        return {};
    };
    WEAVE_CHECK_OK(apply("--set", wish.set, [&](const std::string& text) { return set_number(scene, text); }));
    WEAVE_CHECK_OK(check_each_rim_once(wish.boundaries));
    WEAVE_CHECK_OK(apply("--boundary", wish.boundaries, [&](const std::string& text) { return set_boundary(scene, task.request, text); }));
    WEAVE_CHECK_OK(apply("--pin", wish.pins, [&](const std::string& text) { return add_pin(scene, task.request, block, text); }));
    WEAVE_CHECK_OK(apply("--field", wish.fields, [&](const std::string& text) { return add_field(scene, text); }));
    WEAVE_TRY(task.flips, parse_flips(wish.flips, block));
    if (wish.wraparound) task.request.weft_mode = WeftMode::wraparound;
    if (!wish.region.empty()) {
        WEAVE_TRY(task.request.region, parse_region(wish.region, block));
    }
    task.request.points_per_key = wish.points;
    task.request.reduce = !wish.whole;
    WEAVE_TRY(task.options.backend, sim::parse_backend(wish.backend));
    task.options.threads = wish.threads;
    task.options.residual = wish.residual;
    task.options.most_iterations = wish.steps.value_or(sim::usual_iterations(task.options.solver));
    task.options.most_seconds = wish.seconds.value_or(1e30);
    return task;
}

Result<sim::Plan> plan_of(const Design& design, const Block& block, const sim::SimulationRequest& request, const std::string& file) {
    const Progress progress("planning " + file);
    Result<sim::Plan> plan = sim::make_plan(design, block, request);
    if (!plan) return std::move(plan).error().in(file);
    return plan;
}

Status check_flips_within(const sim::Plan& plan, const std::vector<Flip>& flips) {
    for (const Flip& flip : flips) {
        const bool within = std::ranges::any_of(plan.curves.crossings, [&](const Crossing& crossing) { return crossing.pick == flip.pick && crossing.end == flip.end; });
        if (!within)
            return usage_error("lies outside the part that is simulated (--region)", "--flip " + std::to_string(flip.pick + 1) + "," + std::to_string(flip.end + 1));
    }
    return {};
}

std::string first_points(const SimulateWish& wish) {
    if (wish.start_from == "plan") return "";
    const bool may = wish.resume.empty() && !wish.points && wish.starts == 0 && !wish.symmetry;
    return wish.start_from.empty() && may && wish.fidelity == "reference" ? "standard" : wish.start_from;
}

}  // namespace weave::program
