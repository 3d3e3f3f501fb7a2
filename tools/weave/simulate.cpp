// Relaxing a design into cloth, and looking at the result.

#include "command.hpp"
#include "interrupt.hpp"

#include <weave/core/file.hpp>
#include <weave/core/text.hpp>
#include <weave/picture/cloth_view.hpp>
#include <weave/sim/exports.hpp>
#include <weave/sim/simulate.hpp>
#include <weave/sim/yarns_file.hpp>

#include <array>
#include <charconv>
#include <cstdio>
#include <memory>
#include <optional>
#include <unistd.h>

namespace weave::program {

namespace {

struct Wish {
    std::string file, out, fidelity = "standard", solver = "relax", region;
    std::vector<std::string> set;
    bool wraparound = false, explain = false, whole = false;
    std::optional<double> residual, points, seconds;
    std::optional<std::size_t> steps;
    std::size_t threads = 0;
};

Error usage_error(std::string message, std::string where) {
    return {ErrorCode::usage, std::move(message), std::move(where)};
}

std::optional<double> number_of(std::string_view text) {
    double value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc{} || end != text.data() + text.size()) return {};
    return value;
}

/// `warp.strain=1.01`: a number of the scene, for this run only.
Status set_number(Scene& scene, const std::string& text) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals), where = "--set " + text;
    const std::optional<double> value =
        equals == std::string::npos ? std::nullopt : number_of(std::string_view(text).substr(equals + 1));
    if (!value) return usage_error("write it as NAME=NUMBER, such as warp.strain=1.01", where);
    const std::size_t point = name.find('.');
    const std::string system = name.substr(0, point), what = point == std::string::npos ? "" : name.substr(point + 1);
    SystemScene* of = system == "warp" ? &scene.warp : system == "weft" ? &scene.weft : nullptr;
    std::optional<double>* number = nullptr;
    if (of != nullptr && what == "strain") number = &of->strain;
    if (of != nullptr && what == "stiffness") number = &of->stiffness_scale;
    if (of != nullptr && what == "radius") number = &of->radius_scale;
    if (number == nullptr)
        return usage_error("NAME is warp or weft with strain, stiffness or radius (the latter two are factors), such as weft.radius",
                           where);
    *number = *value;
    return {};
}

/// `picks:1-8,ends:3-12`, from 1: the rows and columns that hold them.
Result<Region> parse_region(const std::string& text, const Block& block) {
    const Error trouble = usage_error("write it as picks:FIRST-LAST,ends:FIRST-LAST within " + std::to_string(block.picks()) +
                                          " picks and " + std::to_string(block.ends()) + " ends",
                                      "--region " + text);
    std::array<std::size_t, 4> bounds{};
    int read = 0;
    if (std::sscanf(text.c_str(), "picks:%zu-%zu,ends:%zu-%zu%n", &bounds[0], &bounds[1], &bounds[2], &bounds[3], &read) != 4 ||
        static_cast<std::size_t>(read) != text.size())
        return trouble;
    if (bounds[0] < 1 || bounds[0] > bounds[1] || bounds[1] > block.picks() || bounds[2] < 1 || bounds[2] > bounds[3] ||
        bounds[3] > block.ends())
        return trouble;
    return Region{block.row_of_pick(bounds[0] - 1), block.row_of_pick(bounds[1] - 1),
                  block.column_of_end(bounds[2] - 1), block.column_of_end(bounds[3] - 1)};
}

Result<sim::Plan> plan_for(Cloth& cloth, const Wish& wish) {
    sim::SimulationRequest request;
    WEAVE_TRY(request.fidelity, sim::parse_fidelity(wish.fidelity));
    for (const std::string& text : wish.set) WEAVE_CHECK_OK(set_number(cloth.design.scene, text));
    WEAVE_CHECK_OK(check(cloth.design));
    if (wish.wraparound) request.weft_mode = WeftMode::wraparound;
    if (!wish.region.empty()) {
        WEAVE_TRY(request.region, parse_region(wish.region, *cloth.evaluation.block));
    }
    request.points_per_key = wish.points;
    request.reduce = !wish.whole;
    return sim::make_plan(cloth.design, *cloth.evaluation.block, request);
}

std::string in_words(const sim::Plan& plan) {
    std::string text;
    for (const sim::PlanLine& line : plan.lines)
        text += "  " + line.term + ": " + line.choice + " (" + line.reason + ")\n";
    return text;
}

/// Tells how far it has come: on a terminal in one line, else once in ten seconds.
class Teller {
  public:
    bool operator()(const sim::Progress& progress) {
        const double now = progress.seconds;
        if (now - m_told >= (m_terminal ? 0.2 : 10)) {
            std::fprintf(stderr, m_terminal ? "\rresidual %.2e after %zu steps, %.1f s " : "residual %.2e after %zu steps, %.1f s\n",
                         progress.residual, progress.iteration, now);
            m_told = now;
            m_open = m_terminal;
        }
        return !interrupted();
    }
    void end() const {
        if (m_open) std::fprintf(stderr, "\r\033[K");
    }

  private:
    bool m_terminal = ::isatty(STDERR_FILENO) == 1, m_open = false;
    double m_told = 0;
};

std::string ending_in_words(const Json& report) {
    char line[200];
    std::snprintf(line, sizeof line, "%s: residual %.1e (goal %.0e) after %zu steps and %.2f s, %zu points, greatest overlap %.0f %%\n",
                  report.at("converged").get<bool>() ? "at rest" : "NOT at rest", report.at("residual").get<double>(),
                  report.at("goal").get<double>(), report.at("iterations").get<std::size_t>(), report.at("seconds").get<double>(),
                  report.at("points").get<std::size_t>(), 100 * report.at("max_overlap").get<double>());
    const auto lost = report.at("lost_crossings").get<std::size_t>();
    return line + (lost == 0 ? std::string("every crossing lies as the card says\n")
                             : counted(lost, "crossing") + " no longer as the card says\n");
}

Status run_simulation(Program& program, const Wish& wish) {
    WEAVE_TRY(Cloth cloth, load_cloth(program, wish.file));
    auto planned = plan_for(cloth, wish);
    if (!planned) return std::move(planned).error().in(wish.file);
    const sim::Plan& plan = *planned;
    if (wish.explain) {
        program.answer({{"plan", sim::lines_json(plan)}, {"yarns", plan.scene.yarns.size()}}, in_words(plan));
        return {};
    }
    if (wish.out.empty()) return usage_error("say where the yarns go: -o OUT.yarns", "");
    Teller teller;
    sim::SimulationOptions options;
    options.threads = wish.threads;
    options.residual = wish.residual;
    WEAVE_TRY(options.solver, sim::parse_solver(wish.solver));
    options.most_iterations = wish.steps.value_or(options.solver == sim::Solver::paper ? 1'000'000 : 2000);
    options.most_seconds = wish.seconds.value_or(1e30);
    options.watch = [&](const sim::Progress& progress) { return teller(progress); };
    const HeldInterrupt held;
    const Yarns yarns = sim::simulate(cloth.design, plan, options);
    teller.end();
    WEAVE_TRY(const std::string bytes, write_yarns(yarns));
    WEAVE_CHECK_OK(write_file(wish.out, bytes));
    Json answer = yarns.report;
    answer["file"] = wish.out;
    program.answer(answer, on_one_line(wish.out) + ", " + ending_in_words(yarns.report));
    const bool good = yarns.report.at("converged").get<bool>() && yarns.report.at("order_kept").get<bool>();
    if (!good) program.exit_code = findings;
    return {};
}

void add_simulate(CLI::App& app, Program& program) {
    CLI::App* command = add_command(app, program, "simulate",
                                    "Relax a design into real cloth: where its yarns come to rest (exit 1: not at rest, or a "
                                    "crossing changed)");
    const auto wish = std::make_shared<Wish>();
    command->add_option("FILE", wish->file, "the .weave file")->required();
    command->add_option("-o,--out", wish->out, "the .yarns file to write")->type_name("FILE");
    command->add_option("--fidelity", wish->fidelity, "draft, standard (if nothing is said) or reference")->type_name("WORD");
    command->add_option("--solver", wish->solver, "relax (if nothing is said), or paper: in time as the paper did, the slow baseline")
        ->type_name("WORD");
    command->add_option("--points", wish->points, "control points for each crossing, instead of the fidelity's")->type_name("N");
    command->add_option("--residual", wish->residual, "how still is still: greatest force over the reference force")
        ->check(CLI::PositiveNumber.description(""))
        ->type_name("N");
    command->add_option("--set", wish->set, "a number of the scene for this run, such as warp.strain=1.02")->type_name("NAME=N");
    command->add_option("--region", wish->region, "only a part, with frozen rims: picks:1-40,ends:1-60")->type_name("PART");
    command->add_flag("--wraparound", wish->wraparound, "the picks of a feeder are one yarn that turns at the edges");
    command->add_flag("--whole", wish->whole, "do not reduce a periodic cloth to its smallest repeat");
    command->add_flag("--explain", wish->explain, "tell what would be simulated and why, and end");
    command->add_option("--steps", wish->steps, "stop after so many steps")->type_name("N");
    command->add_option("--seconds", wish->seconds, "stop after so long")->type_name("N");
    command->add_option("--threads", wish->threads, "processor cores to use; 0: all")->type_name("N");
    on_run(command, program, [=, &program] { return run_simulation(program, *wish); });
}

struct YarnsExport {
    std::string file, out;
};

Status export_yarns(Program& program, const YarnsExport& wish) {
    const std::string extension = lower_extension(wish.out);
    if (extension != ".vtp" && extension != ".obj") return usage_error("yarns are exported as .vtp or .obj", wish.out);
    WEAVE_TRY(const Yarns yarns, load_yarns(wish.file));
    WEAVE_TRY(const std::string bytes, extension == ".vtp" ? write_vtp(yarns) : write_obj(yarns));
    WEAVE_CHECK_OK(write_file(wish.out, bytes));
    program.answer({{"file", wish.out}, {"yarns", yarns.yarns.size()}, {"bytes", bytes.size()}},
                   on_one_line(wish.out) + ": " + counted(yarns.yarns.size(), "yarn") + "\n");
    return {};
}

void add_yarns_export(CLI::App& app, Program& program) {
    CLI::App* command = add_command(app, program, "export-yarns", "Write relaxed yarns for other programs: .vtp (ParaView) or .obj");
    const auto wish = std::make_shared<YarnsExport>();
    command->add_option("FILE", wish->file, "the .yarns file")->required();
    command->add_option("-o,--out", wish->out, "the file to write: .vtp or .obj")->type_name("FILE")->required();
    on_run(command, program, [=, &program] { return export_yarns(program, *wish); });
}

}  // namespace

Result<Yarns> load_yarns(const std::string& file) {
    WEAVE_TRY(const std::string bytes, read_file(file, std::uint64_t{8} << 30));
    Result<Yarns> yarns = read_yarns(bytes);
    if (!yarns) return std::move(yarns).error().in(file);
    return yarns;
}

void add_simulation_commands(CLI::App& app, Program& program) {
    add_simulate(app, program);
    add_yarns_export(app, program);
}

}  // namespace weave::program
