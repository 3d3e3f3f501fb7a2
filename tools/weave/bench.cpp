// Benchmarks of the simulator.

#include "bench_savings.hpp"
#include "bench_scale.hpp"
#include "bench_stability.hpp"
#include "bench_tradeoff.hpp"
#include "command.hpp"
#include "interrupt.hpp"

#include <weave/core/file.hpp>
#include <weave/core/text.hpp>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>

namespace weave::program {

namespace {

namespace fs = std::filesystem;

std::string file_of(const std::string& name) {
    return "tradeoff-" + name + ".json";
}

/// A place that nothing can be written to is told before anything is measured.
Status check_place(const std::string& folder, const std::string& name) {
    if (folder.empty()) return {};
    std::error_code trouble;
    fs::path there = fs::absolute(folder, trouble);
    while (!fs::exists(there, trouble) && there.has_relative_path()) there = there.parent_path();
    if (!fs::is_directory(there, trouble))
        return system_fault(on_one_line(there.string()) + " is not a folder", folder);
    for (const char* ending : {".json", ".md"}) WEAVE_CHECK_OK(check_writable(there / (name + ending)));
    return {};
}

/// Into the folder, which is made once there is something to put there.
Status put(const std::string& folder, const std::string& name, const std::string& bytes) {
    std::error_code trouble;
    fs::create_directories(folder, trouble);
    if (trouble) return system_fault(trouble.message(), folder);
    return write_file(fs::path(folder) / name, bytes);
}

/// What the folder holds of earlier runs; null where there is nothing.
Result<Json> earlier(const std::string& folder, const std::string& name) {
    const std::string file = (fs::path(folder) / file_of(name)).string();
    if (folder.empty() || !fs::exists(file)) return Json();
    WEAVE_TRY(const std::string bytes, read_file(file));
    Json json = Json::parse(bytes, nullptr, false);
    if (!json.is_object() || json.value("name", "") != name)
        return bad_input("not a result of weave bench tradeoff", file);
    return json;
}

constexpr const char* what_follows_an_interrupt =
    "what is under way is not kept; again to end at once, without a word on what was done";

/// What an interrupted benchmark has done of what was asked for: into the answer, and the line for people.
std::string tell_interrupted(CommandOutcome& outcome, Json& answer, std::size_t done, std::size_t asked,
                             const std::string& what) {
    outcome.found_something();
    answer.update({{"interrupted", true}, {"done", done}, {"asked", asked}});
    return "\nINTERRUPTED: " + std::to_string(done) + " of " + counted(asked, what) + " done.\n";
}

/// The answer of a benchmark that is whole or nothing, and its two files in the folder, where one was named.
Status finish(CommandOutcome& outcome, Json answer, std::string words, bool whole, const std::string& folder,
              const std::string& name) {
    if (whole && !folder.empty()) {
        WEAVE_CHECK_OK(put(folder, name + ".json", answer.dump(1) + "\n"));
        WEAVE_CHECK_OK(put(folder, name + ".md", words));
    }
    if (!whole && !folder.empty()) words += "Nothing is written to " + on_one_line(folder) + ".\n";
    outcome.answer(answer, words);
    return {};
}

/// Table and plot are written anew after every structure, so that what was measured is there whatever comes.
Status write_report(const std::string& folder, const Json& structures) {
    if (folder.empty() || structures.empty()) return {};
    WEAVE_CHECK_OK(put(folder, "tradeoff.md", tradeoff_table(structures)));
    WEAVE_TRY(const std::string crimp, tradeoff_plot(structures, PlottedError::crimp));
    WEAVE_CHECK_OK(put(folder, "tradeoff.svg", crimp));
    WEAVE_TRY(const std::string thickness, tradeoff_plot(structures, PlottedError::thickness));
    return put(folder, "tradeoff-thickness.svg", thickness);
}

/// Results as the table lists them.
Json in_order(const std::map<std::string, Json>& known) {
    Json structures = Json::array();
    for (const std::string& name : structure_names()) {
        if (const auto found = known.find(name); found != known.end()) structures.push_back(found->second);
    }
    return structures;
}

/// Measures one after the other and puts each among what is known, until interrupted: how many were done.
Result<std::size_t> measure_all(const std::vector<std::string>& asked, const BenchOptions& options,
                                std::map<std::string, Json>& known) {
    std::size_t done = 0;
    for (const std::string& name : asked) {
        WEAVE_TRY(const Structure structure, make_structure(name));
        Result<Json> measured = measure_tradeoff(structure, options);
        if (interrupted()) break;
        if (!measured) return std::move(measured).error();
        known[name] = std::move(measured).value();
        ++done;
        if (options.folder.empty()) continue;
        WEAVE_CHECK_OK(put(options.folder, file_of(name), known[name].dump(1) + "\n"));
        WEAVE_CHECK_OK(write_report(options.folder, in_order(known)));
    }
    return done;
}

struct TradeoffWish {
    BenchOptions options;
    bool missing = false;
};

Status run_tradeoff(CommandOutcome& outcome, const TradeoffWish& wish) {
    const BenchOptions& options = wish.options;
    for (const std::string& name : options.only) {
        if (const Result<Structure> known = make_structure(name); !known) return known.error();
    }
    if (wish.missing && options.folder.empty())
        return Error{ErrorCode::usage, "of what? Name the folder: -o FOLDER", "--missing"};
    WEAVE_CHECK_OK(check_place(options.folder, "tradeoff"));
    std::map<std::string, Json> known;
    std::vector<std::string> asked;
    for (const std::string& name : structure_names()) {
        WEAVE_TRY(Json json, earlier(options.folder, name));
        const bool named = options.only.empty() ? !is_whole_product(name)
                                                : std::ranges::find(options.only, name) != options.only.end();
        if (named && !(wish.missing && !json.is_null())) asked.push_back(name);
        if (!json.is_null()) known[name] = std::move(json);
    }
    const HeldInterrupt held(what_follows_an_interrupt);
    WEAVE_TRY(const std::size_t done, measure_all(asked, options, known));
    WEAVE_CHECK_OK(write_report(options.folder, in_order(known)));
    Json answer{{"machine", machine_json(options.threads)}, {"structures", in_order(known)}};
    std::string words = tradeoff_table(in_order(known));
    if (done < asked.size()) words += tell_interrupted(outcome, answer, done, asked.size(), "structure");
    outcome.answer(answer, words);
    return {};
}

struct ScaleWish {
    BenchOptions options;
    ScaleOptions scale;
};

Status check_sizes(const ScaleOptions& scale) {
    if (scale.least == 0 || scale.most == 0)
        return Error{ErrorCode::usage, "a cloth has points", scale.least == 0 ? "--least 0" : "--most 0"};
    if (scale.least > scale.most)
        return Error{ErrorCode::usage, "is less than --least " + std::to_string(scale.least),
                     "--most " + std::to_string(scale.most)};
    return {};
}

Status run_scale(CommandOutcome& outcome, const ScaleWish& wish) {
    WEAVE_CHECK_OK(check_sizes(wish.scale));
    WEAVE_CHECK_OK(check_place(wish.options.folder, "scale"));
    const HeldInterrupt held(what_follows_an_interrupt);
    WEAVE_TRY(Json result, measure_scale(wish.options, wish.scale));
    std::string words = scale_table(result);
    const bool whole = !interrupted();
    if (!whole)
        words += tell_interrupted(outcome, result, result.at("sizes").size(),
                                  result.at("asked_points").size(), "size");
    return finish(outcome, std::move(result), std::move(words), whole, wish.options.folder, "scale");
}

/// What one of a list of cases came to; `at` counts from 0.
using MeasureOne = std::function<Result<Json>(std::size_t at)>;

/// Measures one after the other, until interrupted.
Result<Json> measure_each(std::size_t count, const MeasureOne& measure) {
    Json measured = Json::array();
    for (std::size_t k = 0; k < count && !interrupted(); ++k) {
        Result<Json> one = measure(k);
        if (!one && !interrupted()) return std::move(one).error();
        if (one) measured.push_back(std::move(one).value());
    }
    return measured;
}

/// A list of cases told and kept; findings where one has a `fault`.
Status finish_cases(CommandOutcome& outcome, const BenchOptions& options, const Json& cases,
                    std::size_t asked, const std::string& name, const std::string& what, std::string words) {
    const auto bad = std::ranges::count_if(cases, [](const Json& one) { return one.at("fault") != ""; });
    if (bad > 0) outcome.found_something();
    Json answer{{"machine", machine_json(options.threads)}, {what + "s", cases}, {"bad", bad}};
    const bool whole = cases.size() == asked;
    if (!whole) words += tell_interrupted(outcome, answer, cases.size(), asked, what);
    return finish(outcome, std::move(answer), std::move(words), whole, options.folder, name);
}

Status run_savings(CommandOutcome& outcome, const BenchOptions& options) {
    std::vector<std::string> asked;
    for (const std::string& name : options.only.empty() ? saving_names() : options.only) {
        WEAVE_CHECK_OK(check_saving(name));
        if (std::ranges::find(asked, name) == asked.end()) asked.push_back(name);
    }
    WEAVE_CHECK_OK(check_place(options.folder, "savings"));
    const HeldInterrupt held(what_follows_an_interrupt);
    WEAVE_TRY(const Json savings, measure_each(asked.size(), [&](std::size_t k) {
                  tell("savings: " + asked[k]);
                  return measure_saving(asked[k], options);
              }));
    return finish_cases(outcome, options, savings, asked.size(), "savings", "saving",
                        savings_table(savings, machine_json(options.threads)));
}

struct StabilityWish {
    BenchOptions options;
    bool with_long = false;
};

Status run_stability(CommandOutcome& outcome, const StabilityWish& wish) {
    WEAVE_CHECK_OK(check_place(wish.options.folder, "stability"));
    const HeldInterrupt held(
        "the case under way is the last; again to end at once, without a word on what was done");
    std::vector<sim::Extreme> asked = sim::extremes();
    if (!wish.with_long) std::erase_if(asked, [](const sim::Extreme& extreme) { return extreme.is_long; });
    WEAVE_TRY(const Json cases, measure_each(asked.size(), [&](std::size_t k) -> Result<Json> {
                  tell("stability: " + asked[k].name);
                  return measure_extreme(asked[k], wish.options);
              }));
    return finish_cases(outcome, wish.options, cases, asked.size(), "stability", "case",
                        stability_table(cases, machine_json(wish.options.threads)));
}

void add_shared_options(CLI::App* command, BenchOptions& options, const std::string& seconds_help) {
    command->add_option("--seconds", options.seconds, seconds_help)
        ->check(positive_number())
        ->capture_default_str()
        ->type_name("N");
    CLI::Option* threads = add_threads(command, options.threads);
    threads->description(threads->get_description() +
                         "; with 1 seconds are the processor's, so that what runs beside it hardly counts");
    command->footer(
        "Ctrl-C ends it (exit 1), says how much was done, and writes no table of less than that over a whole "
        "one; "
        "again, half a second later or more, ends it at once.\n" +
        command->get_footer());
}

void add_tradeoff(CLI::App& bench, CommandOutcome& outcome) {
    CLI::App* command = add_command(
        bench, outcome, "tradeoff",
        "Speed against accuracy, every solver and fidelity: every sample but the shoes as one gets it, and plain-pinned, a plain weave of 8 by 8 pinned yarns on "
        "which other simulators were measured");
    const auto wish = std::make_shared<TradeoffWish>();
    command
        ->add_option("-o,--out", wish->options.folder,
                     "a folder for tradeoff-NAME.json, tradeoff.md, tradeoff.svg (crimp) and "
                     "tradeoff-thickness.svg; what it holds already of other structures goes into them too")
        ->type_name("FOLDER");
    command
        ->add_option("--only", wish->options.only,
                     "only this sample (again for more), such as satin-e or shoe-baby, or plain-pinned")
        ->type_name("NAME");
    command->add_flag("--missing", wish->missing, "only structures of which the folder holds nothing");
    add_shared_options(command, wish->options, "cap of each run");
    on_run(command, outcome, [=, &outcome] { return run_tradeoff(outcome, *wish); });
}

void add_scale(CLI::App& bench, CommandOutcome& outcome) {
    CLI::App* command =
        add_command(bench, outcome, "scale", "How time and memory grow from 500 to a million points");
    const auto wish = std::make_shared<ScaleWish>();
    command->add_option("-o,--out", wish->options.folder, "a folder for scale.json and scale.md")
        ->type_name("FOLDER");
    command
        ->add_option(
            "--least", wish->scale.least,
            "the smallest size in points; cloth is made of whole repeats, the next smaller or larger number "
            "of them, and has one at least")
        ->transform(whole_number())
        ->capture_default_str()
        ->type_name("N");
    command->add_option("--most", wish->scale.most, "the largest size in points")
        ->transform(whole_number())
        ->capture_default_str()
        ->type_name("N");
    command->add_option("--residual", wish->scale.residual, "how still is still")
        ->check(residual_goal())
        ->capture_default_str()
        ->type_name("N");
    add_shared_options(command, wish->options,
                       "cap of each size; the first that does not come to rest is the last");
    on_run(command, outcome, [=, &outcome] { return run_scale(outcome, *wish); });
}

void add_stability(CLI::App& bench, CommandOutcome& outcome) {
    CLI::App* command = add_command(
        bench, outcome, "stability",
        "The extremes: each ends at rest, or with a report of what and where (exit 1: one did not)");
    const auto wish = std::make_shared<StabilityWish>();
    wish->options.seconds = 30;
    command->add_option("-o,--out", wish->options.folder, "a folder for stability.json and stability.md")
        ->type_name("FOLDER");
    command->add_flag("--long", wish->with_long, "the cases too that take minutes or gigabytes");
    add_shared_options(command, wish->options, "cap of each case");
    on_run(command, outcome, [=, &outcome] { return run_stability(outcome, *wish); });
}

void add_savings(CLI::App& bench, CommandOutcome& outcome) {
    CLI::App* command = add_command(bench, outcome, "savings",
                                    "What a scene does not need is left out: each term kept and left out in "
                                    "turns, what that saves, and how far "
                                    "both results lie apart (exit 1: by more than a tenth of a radius)");
    const auto options = std::make_shared<BenchOptions>();
    command->add_option("-o,--out", options->folder, "a folder for savings.json and savings.md")
        ->type_name("FOLDER");
    command
        ->add_option("--only", options->only, "only this term (again for more), such as friction or repeat")
        ->type_name("NAME");
    add_shared_options(command, *options, "cap of each run");
    on_run(command, outcome, [=, &outcome] { return run_savings(outcome, *options); });
}

}  // namespace

void add_bench_commands(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* bench = app.add_subcommand("bench", "Benchmarks of the simulator")->group("Commands");
    bench->require_subcommand(1);
    add_tradeoff(*bench, outcome);
    add_scale(*bench, outcome);
    add_stability(*bench, outcome);
    add_savings(*bench, outcome);
}

}  // namespace weave::program
