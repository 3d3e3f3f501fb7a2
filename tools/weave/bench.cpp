// Benchmarks of the simulator.

#include "bench_scale.hpp"
#include "bench_tradeoff.hpp"
#include "command.hpp"
#include "interrupt.hpp"

#include <weave/core/file.hpp>
#include <weave/sim/extremes.hpp>

#include <algorithm>
#include <filesystem>

namespace weave::program {

namespace {

namespace fs = std::filesystem;

std::string file_of(const std::string& folder, const std::string& name) {
    return (fs::path(folder) / ("tradeoff-" + name + ".json")).string();
}

Status make_folder(const std::string& folder) {
    std::error_code trouble;
    fs::create_directories(folder, trouble);
    if (trouble) return system_fault(trouble.message(), folder);
    return {};
}

/// What the folder holds of earlier runs; null where there is nothing.
Result<Json> earlier(const std::string& folder, const std::string& name) {
    const std::string file = file_of(folder, name);
    if (folder.empty() || !fs::exists(file)) return Json();
    WEAVE_TRY(const std::string bytes, read_file(file));
    Json json = Json::parse(bytes, nullptr, false);
    if (!json.is_object() || json.value("name", "") != name)
        return bad_input("not a result of weave bench tradeoff", file);
    return json;
}

/// Table and plot are written anew after every structure, so that what was measured is there whatever comes.
Status write_report(const std::string& folder, const Json& structures) {
    if (folder.empty() || structures.empty()) return {};
    WEAVE_CHECK_OK(write_file(fs::path(folder) / "tradeoff.md", tradeoff_table(structures)));
    WEAVE_TRY(const std::string plot, tradeoff_plot(structures));
    return write_file(fs::path(folder) / "tradeoff.svg", plot);
}

struct TradeoffWish {
    BenchOptions options;
    bool missing = false;
};

Status run_tradeoff(Program& program, const TradeoffWish& wish) {
    const BenchOptions& options = wish.options;
    for (const std::string& name : options.only) {
        if (const Result<Structure> known = make_structure(name); !known) return known.error();
    }
    if (!options.folder.empty()) WEAVE_CHECK_OK(make_folder(options.folder));
    Json structures = Json::array();
    for (const std::string& name : structure_names()) {
        WEAVE_TRY(Json json, earlier(options.folder, name));
        const bool asked =
            options.only.empty() || std::ranges::find(options.only, name) != options.only.end();
        if (asked && !(wish.missing && !json.is_null())) {
            WEAVE_TRY(const Structure structure, make_structure(name));
            WEAVE_TRY(json, measure_tradeoff(structure, options));
            if (!options.folder.empty())
                WEAVE_CHECK_OK(write_file(file_of(options.folder, name), json.dump(1) + "\n"));
        }
        if (json.is_null()) continue;
        structures.push_back(std::move(json));
        WEAVE_CHECK_OK(write_report(options.folder, structures));
    }
    program.answer({{"machine", machine_json(options.threads)}, {"structures", structures}},
                   tradeoff_table(structures));
    return {};
}

struct ScaleWish {
    BenchOptions options;
    ScaleOptions scale;
};

Status run_scale(Program& program, const ScaleWish& wish) {
    WEAVE_TRY(const Json result, measure_scale(wish.options, wish.scale));
    if (!wish.options.folder.empty()) {
        WEAVE_CHECK_OK(make_folder(wish.options.folder));
        WEAVE_CHECK_OK(write_file(fs::path(wish.options.folder) / "scale.json", result.dump(1) + "\n"));
        WEAVE_CHECK_OK(write_file(fs::path(wish.options.folder) / "scale.md", scale_table(result)));
    }
    program.answer(result, scale_table(result));
    return {};
}

struct StabilityWish {
    BenchOptions options;
    bool with_long = false;
};

constexpr const char* expectations[]{"rest", "told", "no rest", "refused"};

Json extreme_json(const sim::Extreme& extreme, const sim::ExtremeEnd& end, const std::string& why) {
    return {{"name", extreme.name},
            {"expected", expectations[static_cast<std::size_t>(extreme.expected)]},
            {"good", why.empty()},
            {"fault", why},
            {"converged", end.converged},
            {"refused", end.refused},
            {"residual", end.residual},
            {"overlap", end.overlap},
            {"passed_through", end.passed_through},
            {"points", end.points},
            {"steps", end.iterations},
            {"seconds", end.seconds},
            {"report", end.report}};
}

Status run_stability(Program& program, const StabilityWish& wish) {
    Json cases = Json::array();
    std::string table = "| Case | Must | Points | Steps | s | Ended |\n|---|---|---|---|---|---|\n";
    std::size_t bad = 0;
    const HeldInterrupt held;
    for (const sim::Extreme& extreme : sim::extremes()) {
        if (extreme.is_long && !wish.with_long) continue;
        if (interrupted()) break;
        tell("stability: " + extreme.name);
        const sim::ExtremeEnd end =
            extreme.run({.most_seconds = wish.options.seconds, .threads = wish.options.threads});
        std::string why;
        bad += sim::is_good(extreme, end, why) ? 0 : 1;
        cases.push_back(extreme_json(extreme, end, why));
        table += "| " + extreme.name + " | " + expectations[static_cast<std::size_t>(extreme.expected)] +
                 " | " + std::to_string(end.points) + " | " + std::to_string(end.iterations) + " | " +
                 in_words("%.2f", end.seconds) + " | " + end.report +
                 (why.empty() ? "" : " **BAD: " + why + "**") + " |\n";
    }
    program.answer({{"machine", machine_json(wish.options.threads)}, {"cases", cases}, {"bad", bad}}, table);
    if (bad > 0) program.exit_code = findings;
    return {};
}

void add_shared_options(CLI::App* command, BenchOptions& options, const std::string& seconds_help) {
    command->add_option("--seconds", options.seconds, seconds_help)
        ->check(positive_number())
        ->capture_default_str()
        ->type_name("N");
    command->add_option("--threads", options.threads, "processor cores to use; 0: all")->transform(whole_number())->type_name("N");
}

void add_tradeoff(CLI::App& bench, Program& program) {
    CLI::App* command = add_command(
        bench, program, "tradeoff",
        "Speed against accuracy: the eight structures of the paper's Table 1, every solver and fidelity");
    const auto wish = std::make_shared<TradeoffWish>();
    command
        ->add_option("-o,--out", wish->options.folder,
                     "a folder for tradeoff-NAME.json, tradeoff.md and tradeoff.svg; what it holds already "
                     "of other structures goes into the table too")
        ->type_name("FOLDER");
    command->add_option("--only", wish->options.only, "only this structure (again for more)")
        ->type_name("NAME");
    command->add_flag("--missing", wish->missing, "only structures of which the folder holds nothing");
    add_shared_options(command, wish->options, "cap of each run");
    on_run(command, program, [=, &program] { return run_tradeoff(program, *wish); });
}

void add_scale(CLI::App& bench, Program& program) {
    CLI::App* command =
        add_command(bench, program, "scale", "How time and memory grow from 500 to a million points");
    const auto wish = std::make_shared<ScaleWish>();
    command->add_option("-o,--out", wish->options.folder, "a folder for scale.json and scale.md")
        ->type_name("FOLDER");
    command->add_option("--least", wish->scale.least, "the smallest size in points")
        ->transform(whole_number())
        ->capture_default_str()
        ->type_name("N");
    command->add_option("--most", wish->scale.most, "the largest size in points")
        ->transform(whole_number())
        ->capture_default_str()
        ->type_name("N");
    command->add_option("--residual", wish->scale.residual, "how still is still")
        ->check(positive_number())
        ->capture_default_str()
        ->type_name("N");
    add_shared_options(command, wish->options,
                       "cap of each size; the first that does not come to rest is the last");
    on_run(command, program, [=, &program] { return run_scale(program, *wish); });
}

void add_stability(CLI::App& bench, Program& program) {
    CLI::App* command = add_command(
        bench, program, "stability",
        "The extremes: each ends at rest, or with a report of what and where (exit 1: one did not)");
    const auto wish = std::make_shared<StabilityWish>();
    wish->options.seconds = 30;
    command->add_flag("--long", wish->with_long, "the cases too that take minutes or gigabytes");
    add_shared_options(command, wish->options, "cap of each case");
    on_run(command, program, [=, &program] { return run_stability(program, *wish); });
}

}  // namespace

void add_bench_commands(CLI::App& app, Program& program) {
    CLI::App* bench = app.add_subcommand("bench", "Benchmarks of the simulator")->group("Commands");
    bench->require_subcommand(1);
    add_tradeoff(*bench, program);
    add_scale(*bench, program);
    add_stability(*bench, program);
}

}  // namespace weave::program
