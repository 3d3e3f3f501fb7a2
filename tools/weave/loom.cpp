// Commands that hold a design to a loom: validation, and the export of a sample.

#include "command.hpp"
#include "progress.hpp"

#include <weave/core/exit_code.hpp>
#include <weave/core/file.hpp>
#include <weave/core/text.hpp>
#include <weave/design/document.hpp>
#include <weave/io/sample_export.hpp>
#include <weave/loom/check.hpp>
#include <weave/sim/take_up.hpp>

#include <memory>

namespace weave::program {

namespace {

const std::vector<std::string> severity_names{"off", "info", "warning", "error"};

/// Picks and ends count from 1 for people and programs that read along.
Json number_or_null(const std::optional<std::size_t>& number) {
    return number ? Json(*number + 1) : Json(nullptr);
}

Json to_json(const CheckReport& report) {
    Json findings = Json::array(), missing = Json::array();
    for (const Finding& finding : report.findings) {
        findings.push_back({{"rule", finding.rule},
                            {"severity", severity_names[static_cast<std::size_t>(finding.severity)]},
                            {"pick", number_or_null(finding.pick)},
                            {"end", number_or_null(finding.end)},
                            {"message", finding.message}});
    }
    for (const NotEvaluated& rule : report.not_evaluated)
        missing.push_back({{"rule", rule.rule}, {"reason", rule.reason}});
    return {{"errors", report.count(Severity::error)},      {"warnings", report.count(Severity::warning)},
            {"not_evaluated", report.not_evaluated.size()}, {"findings", std::move(findings)},
            {"not_evaluated_rules", std::move(missing)},    {"passed_rules", report.passed}};
}

std::string in_words(const CheckReport& report, const std::string& loom) {
    std::string text;
    for (const Finding& finding : report.findings) {
        text += severity_names[static_cast<std::size_t>(finding.severity)] + "  " + finding.rule + "  " +
                on_one_line(finding.message) + "\n";
    }
    for (const NotEvaluated& rule : report.not_evaluated)
        text += "not evaluated  " + rule.rule + "  " + on_one_line(rule.reason) + "\n";
    return text + "On " + on_one_line(loom) + ": " + counted(report.count(Severity::error), "error") + ", " +
           counted(report.count(Severity::warning), "warning") + ", " +
           counted(report.passed.size(), "rule") + " passed, " + std::to_string(report.not_evaluated.size()) +
           " not evaluated\n";
}

struct CheckWish {
    std::string file, loom, yarns;
};

/// What relaxed yarns tell. Those of the design in another scene are taken, and it is said.
Result<RelaxedCloth> load_relaxed(const CommandOutcome& outcome, const std::string& file, const Cloth& cloth) {
    WEAVE_TRY(const Yarns yarns, load_cloth(file));
    Result<RelaxedCloth> relaxed = relaxed_cloth(yarns, cloth.design, *cloth.evaluation.block);
    if (!relaxed) return std::move(relaxed).error().in(file);
    if (const auto goes_on = yarns.report.find("goes_on"); goes_on != yarns.report.end() && goes_on->is_string())
        outcome.note(on_one_line(file) + " has the yarns in fewer points of a run to " + goes_on->get<std::string>() +
                     " that is under way or was cut off: simulate it to its end for lengths to go by");
    if (yarns.scene_sha256 != scene_sha256(cloth.design))
        outcome.note(on_one_line(file) + " was simulated with another scene than the design's");
    return relaxed;
}

Status run_check(CommandOutcome& outcome, const CheckWish& wish) {
    WEAVE_TRY(const LoomProfile profile, load_profile(wish.loom));
    WEAVE_TRY(const Cloth cloth, load_cloth(outcome, wish.file));
    note_stray_pin(outcome, cloth, wish.file);
    std::optional<RelaxedCloth> relaxed;
    if (!wish.yarns.empty()) {
        WEAVE_TRY(relaxed, load_relaxed(outcome, wish.yarns, cloth));
    }
    const Progress progress("checking " + wish.file);
    const CheckReport report = check_for_loom(cloth.design, cloth.evaluation, profile, relaxed);
    outcome.answer(to_json(report), in_words(report, profile.name));
    if (report.count(Severity::error) > 0) outcome.found_something();
    return {};
}

void add_check(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command =
        add_command(app, outcome, "check",
                    "Hold a design to a loom, rule by rule; exit status 1 where a rule finds an error");
    const auto wish = std::make_shared<CheckWish>();
    command->add_option("FILE", wish->file, "the .weave file")->required();
    command->add_option("--loom", wish->loom, "the loom's profile, a .json file: db/looms of the tree, share/weave/looms where it is installed")->type_name("FILE")->required();
    command
        ->add_option(
            "--yarns", wish->yarns,
            "its relaxed yarns, a .yarns file: take-up is judged as well, and width and use of yarn told")
        ->type_name("FILE");
    on_run(command, outcome, [=, &outcome] { return run_check(outcome, *wish); });
}

Status export_sample(CommandOutcome& outcome, const std::string& file, const std::string& loom,
                     const std::string& folder) {
    WEAVE_TRY(const LoomProfile profile, load_profile(loom));
    WEAVE_TRY(const Cloth cloth, load_cloth(outcome, file));
    const Progress progress("exporting " + file);
    const CheckReport report = check_for_loom(cloth.design, cloth.evaluation, profile);
    if (report.count(Severity::error) > 0) {
        const Error refusal =
            invalid("does not validate on " + profile.name + ", so nothing is exported", file);
        Json answer = to_json(report);
        answer["error"] = error_json(refusal);
        outcome.answer(answer, in_words(report, profile.name));
        return refusal;
    }
    const std::string stem = std::filesystem::path(file).stem().string();
    WEAVE_TRY(const SampleExport made, make_sample_export(cloth.design, cloth.evaluation, profile, stem));
    WEAVE_CHECK_OK(write_folder(folder, made.files));
    Json listed = Json::array();
    std::string words;
    for (Json entry : made.manifest.at("files")) {
        entry["path"] = (std::filesystem::path(folder) / entry.at("path").get<std::string>()).string();
        words += on_one_line(entry["path"].get<std::string>()) + "\n";
        listed.push_back(std::move(entry));
    }
    outcome.answer(
        {{"files", std::move(listed)}, {"certified", false}, {"released", false}, {"folder", folder}},
        words + "SAMPLE, NOT RELEASED: only a release may go to production.\n");
    return {};
}

void add_export(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command = add_command(app, outcome, "export",
                                    "Write a sample for a loom: card image, pick table and manifest. Refused "
                                    "where validation finds errors");
    const auto file = std::make_shared<std::string>();
    const auto loom = std::make_shared<std::string>();
    const auto folder = std::make_shared<std::string>();
    command->add_option("FILE", *file, "the .weave file")->required();
    command->add_option("--loom", *loom, "the loom's profile, a .json file: db/looms of the tree, share/weave/looms where it is installed")->type_name("FILE")->required();
    command->add_option("-o,--out", *folder, "the folder to write; it must not exist, or be empty")
        ->check(output_name())
        ->type_name("FOLDER")
        ->required();
    on_run(command, outcome, [=, &outcome] { return export_sample(outcome, *file, *loom, *folder); });
}

}  // namespace

void add_loom_commands(CLI::App& app, CommandOutcome& outcome) {
    add_check(app, outcome);
    add_export(app, outcome);
}

}  // namespace weave::program
