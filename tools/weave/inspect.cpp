// Looking relaxed cloth over, and comparing it with what was measured.

#include "command.hpp"

#include <weave/core/file.hpp>
#include <weave/core/text.hpp>
#include <weave/sim/compare.hpp>
#include <weave/sim/inspect.hpp>

#include <algorithm>
#include <cstdio>
#include <memory>

namespace weave::program {

namespace {

bool is_at_rest(const Yarns& yarns) {
    const auto found = yarns.report.find("converged");
    return found != yarns.report.end() && found->is_boolean() && found->get<bool>();
}

Status run_inspection(CommandOutcome& outcome, const std::string& file) {
    WEAVE_TRY(const Yarns yarns, load_cloth(file));
    Result<Inspection> inspection = inspect(yarns);
    if (!inspection) return std::move(inspection).error().in(file);
    outcome.answer(inspection_json(yarns, *inspection), inspection_text(yarns, *inspection));
    if (!is_at_rest(yarns) || !inspection->changed.empty() || !inspection->leaning.empty())
        outcome.found_something();
    return {};
}

void add_inspect(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command = add_command(
        app, outcome, "inspect",
        "Look relaxed cloth over: take-up, crimp, thickness, what leans, bunches, jams or has moved "
        "(exit 1: not at rest, a crossing changed, or a layer leans)");
    const auto file = std::make_shared<std::string>();
    command->add_option("FILE", *file, "the .yarns file of `weave simulate`")->required();
    on_run(command, outcome, [=, &outcome] { return run_inspection(outcome, *file); });
}

std::string yarn_name(const SimulatedYarn& yarn) {
    return (yarn.system == System::warp ? "end " : "pick ") + std::to_string(yarn.number + 1);
}

std::string way_of_matching(MatchedBy matched_by) {
    const char* const words[]{"name", "order", "nearness"};
    return words[static_cast<std::size_t>(matched_by)];
}

Json alignment_json(const sim::Alignment& alignment) {
    Json rotation = Json::array();
    for (int row = 0; row < 3; ++row)
        rotation.push_back(
            {alignment.rotation(row, 0), alignment.rotation(row, 1), alignment.rotation(row, 2)});
    const Vec3& by = alignment.translation;
    return {{"mirrored", alignment.mirrored},
            {"rotation", std::move(rotation)},
            {"translation_mm", {by.x(), by.y(), by.z()}}};
}

Json other_json(const Comparison& comparison) {
    if (!comparison.by_nearness) return nullptr;
    return {{"rms_mm", comparison.by_nearness->rms_mm}, {"max_mm", comparison.by_nearness->max_mm}};
}

Json unit_json(const Comparison& comparison) {
    if (!comparison.unit) return nullptr;
    return {{"unit", comparison.unit->unit},
            {"mm", comparison.unit->mm},
            {"rms_mm", comparison.unit->rms_mm},
            {"matched_by", way_of_matching(comparison.unit->matched_by)}};
}

Json comparison_json(const Yarns& yarns, const MeasuredCloth& measured, const Comparison& comparison) {
    Json per_yarn = Json::array(), measured_alone = Json::array(), simulated_alone = Json::array();
    for (const YarnDeviation& deviation : comparison.per_yarn) {
        const SimulatedYarn& yarn = yarns.yarns[deviation.simulated];
        per_yarn.push_back({{"kind", yarn.system == System::warp ? "end" : "pick"},
                            {"number", yarn.number + 1},
                            {"measured", deviation.measured + 1},
                            {"rms_mm", deviation.rms_mm},
                            {"max_mm", deviation.max_mm},
                            {"max_at_mm", {deviation.worst.x(), deviation.worst.y(), deviation.worst.z()}},
                            {"radius_mm", yarn.radius_mm}});
        if (const std::size_t line = measured.yarns[deviation.measured].line; line > 0)
            per_yarn.back()["line"] = line;
    }
    for (const std::size_t m : comparison.measured_alone) measured_alone.push_back(m + 1);
    for (const std::size_t s : comparison.simulated_alone)
        simulated_alone.push_back(yarn_name(yarns.yarns[s]));
    return {{"rms_mm", comparison.rms_mm},
            {"max_mm", comparison.max_mm},
            {"matched_by", way_of_matching(comparison.matched_by)},
            {"alignment", alignment_json(comparison.alignment)},
            {"by_nearness", other_json(comparison)},
            {"unit_hint", unit_json(comparison)},
            {"per_yarn", std::move(per_yarn)},
            {"measured_without_partner", std::move(measured_alone)},
            {"simulated_without_partner", std::move(simulated_alone)}};
}

std::string short_number(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", number);
    return text;
}

std::string millimetres(double length) {
    char text[64];
    std::snprintf(text, sizeof text, "%.3f mm", length);
    return text;
}

std::string matching_text(const Comparison& comparison) {
    switch (comparison.matched_by) {
        case MatchedBy::name:
            return "matched by pick and end";
        case MatchedBy::order:
            return "matched in the order of the files";
        case MatchedBy::nearness:
            break;
    }
    return "matched by nearness";
}

/// What would fit far better.
std::string hints_text(const Comparison& comparison) {
    std::string text;
    if (const auto& other = comparison.by_nearness)
        text +=
            "Matched by nearness they lie only " + millimetres(other->rms_mm) + " apart (rms), " +
            millimetres(other->max_mm) +
            " at most: the measured yarns may stand in another order; --match nearness compares them so\n";
    if (const auto& unit = comparison.unit)
        text += "If the measured places are in " + unit->unit + " and not in mm they lie only " +
                millimetres(unit->rms_mm) + " apart (rms)" +
                (unit->matched_by == comparison.matched_by
                     ? ""
                     : ", matched by " + way_of_matching(unit->matched_by)) +
                ": multiply them by " + short_number(unit->mm) + "\n";
    return text;
}

std::string comparison_text(const Yarns& yarns, const MeasuredCloth& measured, const Comparison& comparison) {
    std::string text = counted(comparison.per_yarn.size(), "yarn") + " " + matching_text(comparison) + "\n";
    if (comparison.alignment.mirrored)
        text +=
            "The measured axes are right-handed, those of the cloth left-handed: x and y were exchanged\n";
    text += "Deviation " + millimetres(comparison.rms_mm) + " on the mean (rms), " +
            millimetres(comparison.max_mm) + " at most\n" + hints_text(comparison);
    std::vector<YarnDeviation> worst = comparison.per_yarn;
    std::ranges::stable_sort(worst, std::greater{}, &YarnDeviation::rms_mm);
    worst.resize(std::min<std::size_t>(worst.size(), 5));
    for (const YarnDeviation& deviation : worst)
        text += "  " + yarn_name(yarns.yarns[deviation.simulated]) + ": " + millimetres(deviation.rms_mm) +
                ", at most " + millimetres(deviation.max_mm) + "\n";
    if (comparison.per_yarn.size() > worst.size()) text += "  the others less; --json has all\n";
    if (!comparison.measured_alone.empty())
        text += counted(comparison.measured_alone.size(), "measured yarn") +
                " without a partner, such as the " + std::to_string(comparison.measured_alone.front() + 1) +
                ". of " + std::to_string(measured.yarns.size()) + "\n";
    if (!comparison.simulated_alone.empty())
        text += counted(comparison.simulated_alone.size(), "simulated yarn") +
                " without a partner, such as " + yarn_name(yarns.yarns[comparison.simulated_alone.front()]) +
                "\n";
    return text;
}

Status run_comparison(CommandOutcome& outcome, const std::string& file, const std::string& measured_file,
                      const std::string& match) {
    WEAVE_TRY(const Yarns yarns, load_cloth(file));
    WEAVE_TRY(const std::string bytes, read_file(measured_file, std::uint64_t{8} << 30));
    Result<MeasuredCloth> measured = read_measured_cloth(bytes);
    if (!measured) return std::move(measured).error().in(measured_file);
    const auto wish = match.empty()
                          ? std::nullopt
                          : std::optional(match == "order" ? MatchedBy::order : MatchedBy::nearness);
    Result<Comparison> comparison = compare(yarns, *measured, wish);
    if (!comparison) return std::move(comparison).error().in(file);
    outcome.answer(comparison_json(yarns, *measured, *comparison),
                   comparison_text(yarns, *measured, *comparison));
    return {};
}

void add_compare(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command =
        add_command(app, outcome, "compare",
                    "Tell how far relaxed yarns lie from measured ones, once these are laid on them");
    const auto file = std::make_shared<std::string>(), measured = std::make_shared<std::string>(),
               match = std::make_shared<std::string>();
    command->add_option("FILE", *file, "the .yarns file of `weave simulate`")->required();
    command
        ->add_option("MEASURED", *measured,
                     "centrelines in mm as text (for each yarn a line with the number of its points, then "
                     "lines x y z), or a .yarns file")
        ->required();
    command
        ->add_option(
            "--match", *match,
            "which measured yarn is which: in the order of the files (order), or the nearest (nearness); without it by pick and "
            "end where both files name them, else in order where there are as many, else the nearest")
        ->check(one_of({"order", "nearness"}))
        ->type_name("HOW");
    on_run(command, outcome, [=, &outcome] { return run_comparison(outcome, *file, *measured, *match); });
}

}  // namespace

void add_inspection_commands(CLI::App& app, CommandOutcome& outcome) {
    add_inspect(app, outcome);
    add_compare(app, outcome);
}

}  // namespace weave::program
