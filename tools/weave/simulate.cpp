// Relaxing a design into cloth, and looking at the result.

#include "command.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "simulate_words.hpp"

#include <weave/core/file.hpp>
#include <weave/core/sha256.hpp>
#include <weave/core/text.hpp>
#include <weave/design/document.hpp>
#include <weave/design/edit.hpp>
#include <weave/picture/cloth_view.hpp>
#include <weave/sim/exports.hpp>
#include <weave/sim/simulate.hpp>
#include <weave/sim/starts.hpp>
#include <weave/sim/symmetry.hpp>
#include <weave/sim/yarns_file.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <unistd.h>

namespace weave::program {

namespace {

struct Wish {
    std::string file, out, fidelity = "standard", region, solver = "relax", backend = "cpu", resume, save_design, start_from;
    std::vector<std::string> set, boundaries, pins, fields, flips;
    bool wraparound = false, explain = false, whole = false, symmetry = false;
    std::optional<double> residual, points, seconds;
    std::optional<std::size_t> steps;
    std::size_t threads = 0, starts = 0;
    std::optional<std::uint64_t> seed;
    std::string no_plan_option;  ///< the first given that makes no difference to the plan
};

Error usage_error(std::string message, std::string where) {
    return {ErrorCode::usage, std::move(message), std::move(where)};
}

/// What is to be done, understood.
struct Task {
    Design design;  ///< with the scene of this run
    std::string file_scene_sha256;  ///< of the scene as the file has it
    sim::SimulationRequest request;
    sim::SimulationOptions options;
    std::vector<Flip> flips;
    std::optional<sim::Plan> coarser;  ///< where options.coarser points to
};

Status check_backend(const std::string& backend) {
    if (backend == "cpu") return {};
    if (backend == "cuda") return system_fault("this program was built without CUDA: use the backend cpu", "--backend cuda");
    return usage_error("backend is cpu or cuda", "--backend " + backend);
}

/// What is read or written besides is not written over. Two files may change in place: yarns that are gone on from, and
/// the design that gets its flips.
Status check_files(const Wish& wish) {
    WEAVE_CHECK_OK(keep_apart(wish.out, wish.file, "the design that is read"));
    WEAVE_CHECK_OK(keep_apart(wish.save_design, wish.out, "the file for the yarns (-o)"));
    return keep_apart(wish.save_design, wish.resume, "the file of yarns that are gone on from");
}

Status check_wish(const Wish& wish) {
    WEAVE_CHECK_OK(check_backend(wish.backend));
    WEAVE_CHECK_OK(check_files(wish));
    if (!wish.explain && wish.out.empty()) return usage_error("say where the yarns go: -o OUT.yarns", "");
    if (wish.explain && !wish.no_plan_option.empty())
        return usage_error("nothing is simulated with --explain, and the plan owes nothing to it", wish.no_plan_option);
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
    return {};
}

Result<Task> understand(Cloth cloth, const Wish& wish) {
    const Block& block = *cloth.evaluation.block;
    Task task;
    task.file_scene_sha256 = scene_sha256(cloth.design);
    task.design = std::move(cloth.design);
    Scene& scene = task.design.scene;
    WEAVE_TRY(task.request.fidelity, sim::parse_fidelity(wish.fidelity));
    WEAVE_TRY(task.options.solver, sim::parse_solver(wish.solver));
    for (const std::string& text : wish.set) WEAVE_CHECK_OK(set_number(scene, text));
    for (const std::string& text : wish.boundaries) WEAVE_CHECK_OK(set_boundary(scene, task.request, text));
    for (const std::string& text : wish.pins) WEAVE_CHECK_OK(add_pin(scene, task.request, block, text));
    for (const std::string& text : wish.fields) WEAVE_CHECK_OK(add_field(scene, text));
    WEAVE_TRY(task.flips, parse_flips(wish.flips, block));
    WEAVE_CHECK_OK(check(task.design));
    if (wish.wraparound) task.request.weft_mode = WeftMode::wraparound;
    if (!wish.region.empty()) {
        WEAVE_TRY(task.request.region, parse_region(wish.region, block));
    }
    task.request.points_per_key = wish.points;
    task.request.reduce = !wish.whole;
    task.options.threads = wish.threads;
    task.options.residual = wish.residual;
    task.options.most_iterations = wish.steps.value_or(task.options.solver == sim::Solver::paper ? 1'000'000 : 20'000);
    task.options.most_seconds = wish.seconds.value_or(1e30);
    return task;
}

std::string in_words(const sim::Plan& plan) {
    std::string text;
    for (const sim::PlanLine& line : plan.lines)
        text += "  " + line.term + ": " + line.choice + " (" + line.reason + ")\n";
    return text;
}

/// Tells how far it has come and how long it may still take: on a terminal in one line, else after a second and then once
/// in ten.
class Teller {
  public:
    explicit Teller(double goal) : m_goal(goal) {}

    /// What relaxes from now on, such as ` the whole cloth`, and to which residual if not the same as before.
    void turn_to(std::string what, std::optional<double> goal = {}) {
        m_what = std::move(what);
        m_goal = goal.value_or(m_goal);
        m_next = std::min(m_next, seconds() + first_after);
    }

    bool operator()(const sim::Progress& progress) {
        const double now = seconds();
        if (progress.iteration < m_iteration) m_past.clear();  // another run
        m_iteration = progress.iteration;
        if (progress.residual > 0) m_past.push_back({now, std::log(progress.residual)});
        if (progress.residual > 0 && now >= m_next) {
            tell(progress, now);
            m_next = now + (m_terminal ? 0.2 : 10);
        }
        return !interrupted();
    }
    void end() const {
        if (m_open) std::fprintf(stderr, "\r\033[K");
    }

  private:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count();
    }

    void tell(const sim::Progress& progress, double now) {
        const std::optional<double> left = seconds_left();
        char to_go[40] = "";
        if (left) std::snprintf(to_go, sizeof to_go, "to go some %.*f s, ", *left < 10 ? 1 : 0, *left);
        std::fprintf(stderr, "%srelaxing%s ... residual %.2e (goal %.0e) after %zu steps, %s%sso far %.1f s%s", m_terminal ? "\r" : "",
                     m_what.c_str(), progress.residual, m_goal, progress.iteration, order_of(progress).c_str(), to_go, now,
                     m_terminal ? "\033[K" : "\n");
        m_open = m_terminal;
    }

    /// Nothing before crossings were looked up first.
    static std::string order_of(const sim::Progress& progress) {
        if (!progress.lost_crossings) return "";
        return *progress.lost_crossings == 0 ? "order kept, " : counted(*progress.lost_crossings, "crossing") + " out of order, ";
    }

    struct Past {
        double seconds, log_residual;
    };

    /// By how fast the residual fell in the last third of the time; nothing while it does not fall.
    [[nodiscard]] std::optional<double> seconds_left() const {
        const Past& now = m_past.back();
        const auto then = std::find_if(m_past.begin(), m_past.end(),
                                       [&](const Past& past) { return past.seconds >= now.seconds * 2 / 3; });
        const double fell = then->log_residual - now.log_residual;
        if (!(fell > 0.1)) return {};
        return std::max(0.0, (now.log_residual - std::log(m_goal)) / fell * (now.seconds - then->seconds));
    }

    static constexpr double first_after = 1;

    double m_goal;
    std::string m_what;
    bool m_terminal = ::isatty(STDERR_FILENO) == 1, m_open = false;
    double m_next = first_after;
    std::size_t m_iteration = 0;
    std::vector<Past> m_past;
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

std::string flips_in_words(const Json& report) {
    std::string text;
    if (!report.contains("flips")) return text;
    for (const Json& flip : report.at("flips")) {
        const std::string pair = "pick " + std::to_string(flip.at("pick").get<std::size_t>()) + " and end " +
                                 std::to_string(flip.at("end").get<std::size_t>());
        char seconds[40];
        std::snprintf(seconds, sizeof seconds, " (%.2f s)\n",
                      flip.at("flip_seconds").get<double>() + flip.at("settle_seconds").get<double>());
        text += flip.at("done").get<bool>() ? pair + " have changed sides" + seconds
                                            : pair + " stay as they were: " + flip.at("reason").get<std::string>() + "\n";
    }
    return text;
}

/// Which part of the cloth was simulated, where it is not all.
std::string coverage_in_words(const Json& report) {
    const Json& coverage = report.at("coverage");
    if (coverage.at("whole").get<bool>() || !coverage.contains("picks")) return "";
    const auto number = [&](const char* name, std::size_t k) { return std::to_string(coverage.at(name).at(k).get<std::size_t>()); };
    return "only picks " + number("picks", 0) + " to " + number("picks", 1) + " and ends " + number("ends", 0) + " to " +
           number("ends", 1) + " of the cloth\n";
}

std::string friction_in_words(const Json& report) {
    if (!report.contains("friction")) return "";
    const Json& friction = report.at("friction");
    char line[200];
    std::snprintf(line, sizeof line, "friction %g: its forces %s after %zu rounds; %.0f %% of what presses sticks, the rest slipped by up to %.2f mm\n",
                  friction.at("coefficient").get<double>(), friction.at("agreed").get<bool>() ? "agree with the rest" : "do NOT agree with the rest",
                  friction.at("rounds").get<std::size_t>(), 100 * friction.at("stuck_share").get<double>(),
                  friction.at("farthest_slip_mm").get<double>());
    return line;
}

/// Which points it began in, and whether the others went on from there.
std::string start_in_words(const Json& report) {
    if (!report.contains("coarser") || report.contains("goes_on")) return "";
    const Json& coarser = report.at("coarser");
    char line[200];
    std::snprintf(line, sizeof line, "began in %zu points (%s): residual %.1e after %zu steps and %.2f s%s\n",
                  coarser.at("points").get<std::size_t>(), coarser.at("fidelity").get<std::string>().c_str(),
                  coarser.at("residual").get<double>(), coarser.at("iterations").get<std::size_t>(), coarser.at("seconds").get<double>(),
                  coarser.at("taken").get<bool>() ? "" : "; NOT gone on from, as crossings lay wrong in so few: begun anew as planned");
    return line;
}

std::string interruption_in_words(const Json& report) {
    if (!report.contains("left_undone")) return "";
    std::string text = report.contains("interrupted") ? "INTERRUPTED, left undone: " : "CUT SHORT, left undone: ";
    for (const Json& what : report.at("left_undone")) text += (text.back() == ' ' ? "" : ", ") + what.get<std::string>();
    return text + "\n";
}

/// Periods that should have relaxed and did not come to the force asked for.
std::string periods_in_words(const Json& report) {
    if (!report.contains("periods") || report.at("periods").at("balanced").get<bool>()) return "";
    const Json& periods = report.at("periods");
    std::string text;
    for (const std::size_t k : {0, 1}) {
        if (periods.at("asked_N").at(k).is_null()) continue;
        char line[200];
        std::snprintf(line, sizeof line, "the period along %c is NOT settled after %zu rounds: its rim pulls with %.3g N, asked for were %.3g N\n",
                      k == 0 ? 'x' : 'y', periods.at("rounds").get<std::size_t>(), periods.at("force_N").at(k).get<double>(),
                      periods.at("asked_N").at(k).get<double>());
        text += line;
    }
    return text;
}

/// Whether it is at rest, and where it never came to what was asked for, whose yarns these are.
std::string rest_in_words(const Json& report) {
    if (!report.contains("goes_on")) return report.at("converged").get<bool>() ? "at rest" : "NOT at rest";
    return "NOT at rest: " + report.at("goes_on").get<std::string>() + ", which was asked for, was not begun; these are the yarns in the fewer points of " +
           report.at("fidelity").get<std::string>();
}

std::string ending_in_words(const Json& report) {
    const Json& goal = (report.contains("goes_on") ? report.at("coarser") : report).at("goal");
    char line[300];
    std::snprintf(line, sizeof line, "%s: residual %.1e (goal %.0e) after %zu steps and %.2f s, %zu points, greatest overlap %.0f %%\n",
                  rest_in_words(report).c_str(), report.at("residual").get<double>(), goal.get<double>(), report.at("iterations").get<std::size_t>(), report.at("seconds").get<double>(),
                  report.at("points").get<std::size_t>(), 100 * report.at("max_overlap").get<double>());
    const auto lost = report.at("lost_crossings").get<std::size_t>();
    const auto slid = report.at("slid_crossings").get<std::size_t>();
    std::string order = lost > 0 ? counted(lost, "crossing") + " no longer as the card says\n"
                        : slid > 0 ? "" : "every crossing lies as the card says\n";
    if (slid > 0) order += counted(slid, "crossing") + " no longer where planned, open or not held; no yarn passed through another there\n";
    return line + start_in_words(report) + periods_in_words(report) + order + coverage_in_words(report) + friction_in_words(report) + flips_in_words(report) +
           sim::starts_text(report) + sim::symmetry_text(report) + interruption_in_words(report);
}

/// What a run that was interrupted, or whose time or steps were up, was asked for and has not done, in words.
std::vector<std::string> left_undone(const Json& report, const Task& task, const Wish& wish) {
    std::vector<std::string> undone;
    const auto add = [&](std::size_t done, std::size_t asked, const char* what) {
        if (done < asked) undone.push_back(std::to_string(asked - done) + " of " + counted(asked, what));
    };
    const Json flips = report.value("flips", Json::array());
    const std::string ending = report.at("ending");
    if (report.contains("goes_on")) undone.push_back("the fidelity asked for, " + report.at("goes_on").get<std::string>());
    else if (ending == "stopped" || ending == "time" || ending == "iterations") undone.emplace_back("coming to rest");
    add(static_cast<std::size_t>(std::ranges::count_if(flips, [](const Json& flip) { return flip.at("tried").get<bool>(); })),
        task.flips.size(), "flip");
    add(report.value("starts", Json::object()).value("runs", std::size_t{0}), wish.starts, "more relaxation");
    if (wish.symmetry && !report.contains("symmetry")) undone.emplace_back("the whole cloth beside its smallest repeat");
    return undone;
}

/// The state to go on from, out of a .yarns file.
Result<sim::StartState> taken_up(const std::string& file, const sim::Plan& plan, const Task& task) {
    WEAVE_TRY(const Yarns yarns, load_yarns(file));
    auto start = sim::start_from(plan, yarns, design_sha256(task.design), {scene_sha256(task.design), task.file_scene_sha256});
    if (!start) return std::move(start).error().in(file);
    return start;
}

/// What is simulated; planning a large cloth takes its time, which is told.
Result<sim::Plan> plan_of(const Design& design, const Block& block, const sim::SimulationRequest& request, const std::string& file) {
    const Progress progress("planning " + file);
    Result<sim::Plan> plan = sim::make_plan(design, block, request);
    if (!plan) return std::move(plan).error().in(file);
    return plan;
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
Result<Yarns> relaxed(const Block& block, Task& task, const sim::Plan& plan, const Wish& wish) {
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
Result<Yarns> compared_with_whole(const Block& block, const Task& task, const Wish& wish, Teller& teller) {
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
Result<Yarns> simulated(const Block& block, Task& task, const sim::Plan& plan, const Wish& wish, Teller& teller) {
    WEAVE_TRY(Yarns yarns, wish.symmetry ? compared_with_whole(block, task, wish, teller) : relaxed(block, task, plan, wish));
    teller.turn_to(" from other starts");
    if (wish.starts > 0 && !interrupted())
        yarns.report["starts"] = sim::relaxed_again(task.design, plan, task.options, yarns, wish.starts, wish.seed.value_or(1));
    return yarns;
}

/// Which fidelity's points a run begins in; empty: its own. `reference` refines the rest that `standard` comes to, so that the
/// two can be compared, and is there sooner as a rule (docs/simulation).
std::string first_points(const Wish& wish) {
    if (wish.start_from == "plan") return "";
    const bool may = wish.resume.empty() && !wish.points && wish.starts == 0 && !wish.symmetry;
    return wish.start_from.empty() && may && wish.fidelity == "reference" ? "standard" : wish.start_from;
}

/// What the coarser yarns say of themselves while they stand for the finer ones to come.
Status show_coarser(const Yarns& yarns, const std::string& file) {
    WEAVE_TRY(const std::string bytes, write_yarns(yarns));
    return write_file(file, bytes);
}

/// Lets the run begin in the points of another fidelity. The file has its yarns as soon as these are at rest.
Status start_coarser(const Block& block, Task& task, const sim::Plan& plan, const Wish& wish, Teller& teller, Status& shown) {
    const std::string start_from = first_points(wish);
    if (start_from.empty()) return {};
    sim::SimulationRequest request = task.request;
    request.points_per_key.reset();
    WEAVE_TRY(request.fidelity, sim::parse_fidelity(start_from));
    // Half as many points alone save little: work follows the contact samples. At up to 0.45 no yarn was seen to pass another.
    if (request.fidelity == sim::Fidelity::draft) request.sample_spacing = 0.4;
    WEAVE_TRY(task.coarser, plan_of(task.design, block, request, wish.file));
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
Result<Yarns> watched(const Block& block, Task& task, const sim::Plan& plan, const Wish& wish) {
    Teller teller(wish.residual.value_or(plan.goal));
    task.options.watch = [&](const sim::Progress& progress) { return teller(progress); };
    Status shown;
    WEAVE_CHECK_OK(start_coarser(block, task, plan, wish, teller, shown));
    WEAVE_TRY(Yarns yarns, simulated(block, task, plan, wish, teller));
    WEAVE_CHECK_OK(shown);
    teller.end();
    const std::vector<std::string> undone = left_undone(yarns.report, task, wish);
    if (!undone.empty()) yarns.report["left_undone"] = undone;
    if (!undone.empty() && interrupted()) yarns.report["interrupted"] = true;
    return yarns;
}

/// Flips of a part of the cloth lie in it.
Status check_flips_within(const sim::Plan& plan, const std::vector<Flip>& flips) {
    for (const Flip& flip : flips) {
        const bool within = std::ranges::any_of(plan.curves.crossings, [&](const Crossing& crossing) { return crossing.pick == flip.pick && crossing.end == flip.end; });
        if (!within)
            return usage_error("lies outside the part that is simulated (--region)", "--flip " + std::to_string(flip.pick + 1) + "," + std::to_string(flip.end + 1));
    }
    return {};
}

/// The design with the flips that were made, in the scene of its file.
Status save_flipped(Design design, const Task& task, const Yarns& yarns, const std::string& file) {
    for (std::size_t k = 0; k < yarns.report.at("flips").size(); ++k) {
        if (yarns.report.at("flips").at(k).at("done").get<bool>())
            WEAVE_CHECK_OK(apply_edit(design, PutFlip{design.root, task.flips[k]}));
    }
    return save_design(design, file);
}

bool is_any_flip_done(const Json& report) {
    return std::ranges::any_of(report.at("flips"), [](const Json& flip) { return flip.at("done").get<bool>(); });
}

bool is_good(const Json& report) {
    const auto is_done = [](const Json& flip) { return flip.at("done").get<bool>(); };
    const Json flips = report.value("flips", Json::array());
    return !report.contains("left_undone") && report.at("converged").get<bool>() && report.at("order_kept").get<bool>() &&
           std::all_of(flips.begin(), flips.end(), is_done);
}

Status run_simulation(CommandOutcome& outcome, const Wish& wish) {
    WEAVE_CHECK_OK(check_wish(wish));
    WEAVE_TRY(const Cloth cloth, load_cloth(outcome, wish.file));
    const Block& block = *cloth.evaluation.block;
    auto understood = understand(cloth, wish);
    if (!understood) return std::move(understood).error().in(wish.file);
    Task& task = *understood;
    WEAVE_TRY(const sim::Plan plan, plan_of(task.design, block, task.request, wish.file));
    if (wish.explain) {
        outcome.answer({{"plan", sim::lines_json(plan)}, {"yarns", plan.scene.yarns.size()}}, in_words(plan));
        return {};
    }
    if (task.request.region) {
        WEAVE_CHECK_OK(check_flips_within(plan, task.flips));
    }
    const HeldInterrupt held("the yarns are written as they lie; again to end at once, without the state");
    WEAVE_TRY(const Yarns yarns, watched(block, task, plan, wish));
    WEAVE_TRY(const std::string bytes, write_yarns(yarns));
    WEAVE_CHECK_OK(write_file(wish.out, bytes));
    Json answer = yarns.report;
    answer["file"] = wish.out;
    answer["yarns_sha256"] = sha256_hex(bytes);
    std::string words = on_one_line(wish.out) + ", " + ending_in_words(yarns.report);
    if (!wish.save_design.empty()) {
        const bool any = is_any_flip_done(yarns.report);
        answer["saved_design"] = any ? Json(wish.save_design) : Json(nullptr);
        if (!any) words += on_one_line(wish.save_design) + " is NOT written: no flip was made\n";
        if (any) {
            WEAVE_CHECK_OK(save_flipped(cloth.design, task, yarns, wish.save_design));
        }
    }
    outcome.answer(answer, words);
    if (!is_good(yarns.report)) outcome.found_something();
    return {};
}

void add_simulate(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command = add_command(app, outcome, "simulate",
                                    "Relax a design into real cloth: where its yarns come to rest (exit 1: not at rest, or a "
                                    "crossing changed)");
    const auto wish = std::make_shared<Wish>();
    command->add_option("FILE", wish->file, "the .weave file")->required();
    command->add_option("-o,--out", wish->out, "the .yarns file to write")->type_name("FILE");
    command->add_option("--fidelity", wish->fidelity, "draft, standard (if nothing is said) or reference")->type_name("WORD");
    command->add_option("--solver", wish->solver, "relax (if nothing is said), or paper: in time as the paper did, the slow baseline")
        ->type_name("WORD");
    command->add_option("--points", wish->points, "control points for each crossing, instead of the fidelity's")->check(positive_number())->type_name("N");
    command->add_option("--residual", wish->residual, "how still is still: greatest force over the reference force")
        ->check(positive_number())
        ->type_name("N");
    command->add_option("--set", wish->set, "a number of the scene for this run, such as warp.strain=1.02 or friction=0.2")->type_name("NAME=N");
    command->add_option("--backend", wish->backend, "what computes: cpu (if nothing is said) or cuda")->type_name("WORD");
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
    command->add_option("--seconds", wish->seconds, "stop after so long in all; each run of --starts and --symmetry has as long")->check(positive_number())->type_name("N");
    add_threads(command, wish->threads);
    command->footer("Ctrl-C writes the yarns as they lie (exit 1), for --resume to go on from; again, half a second later or more, ends at "
                    "once without them.\n" + command->get_footer());
    on_run(command, outcome, [=, &outcome] {
        wish->no_plan_option = given_of(command, {"--out", "--solver", "--residual", "--backend", "--flip", "--save-design", "--resume", "--start-from", "--starts",
                                                  "--symmetry", "--seed", "--steps", "--seconds", "--threads"});
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
