// verify-files: whether what lies at a loom is what people signed, without any server.

#include <weave/core/exit_code.hpp>
#include <weave/core/file.hpp>
#include <weave/core/text.hpp>

#include <loomlink/commands/command.hpp>
#include <loomlink/commands/names.hpp>
#include <loomlink/commands/puller.hpp>
#include <memory>

namespace weave::loomlink {

namespace {

struct VerifyWords {
    std::string folder, state_file, loom, trust_file;
};

/// Whom to believe, and, where a terminal knows it, what became of the releases.
struct Believed {
    TrustDocument trust;
    std::optional<TerminalState> state;
};

Result<Believed> believed(const VerifyWords& words) {
    const int given =
        int(!words.state_file.empty()) + int(!words.loom.empty()) + int(!words.trust_file.empty());
    if (given != 1)
        return Error{ErrorCode::usage, "say whom to believe: one of --state, --loom and --trust", ""};
    if (!words.trust_file.empty()) {
        WEAVE_TRY(const std::string bytes, read_file(words.trust_file, most_trust_bytes));
        auto trust = read_trust(bytes);
        if (!trust && trust.error().code == ErrorCode::refused)  // it is not what its people signed either
            return invalid(trust.error().message, trust.error().where).in(words.trust_file);
        if (!trust) return std::move(trust).error().in(words.trust_file);
        return Believed{*std::move(trust), {}};
    }
    std::filesystem::path file = words.state_file;
    if (file.empty()) {
        WEAVE_TRY(file, usual_state_file(words.loom));
    }
    WEAVE_TRY(TerminalState state, load_state(file));
    return Believed{state.trust, state};
}

const char* trouble_word(FileTrouble trouble) {
    switch (trouble) {
        case FileTrouble::missing:
            return "missing";
        case FileTrouble::differs:
            return "differs";
        case FileTrouble::too_many:
            return "too many";
        case FileTrouble::not_a_file:
            return "not a file";
        case FileTrouble::unreadable:
            break;
    }
    return "unreadable";
}

Json report_json(const FolderReport& report, const Status& recall, bool knows_recalls) {
    Json findings = Json::array();
    for (const FileFinding& finding : report.findings)
        findings.push_back({{"file", finding.path},
                            {"trouble", trouble_word(finding.trouble)},
                            {"message", finding.message}});
    Json json{{"loom", report.manifest.loom},
              {"release", report.manifest.release},
              {"design", report.manifest.design},
              {"revision", report.manifest.revision},
              {"files", report.manifest.files.size()},
              {"findings", std::move(findings)},
              {"recall_known", knows_recalls},
              {"may_not_be_woven", recall ? Json(nullptr) : Json(recall.error().message)}};
    if (!recall) json["error"] = error_json(recall.error());
    return json;
}

std::string report_words(const FolderReport& report, bool knows_recalls) {
    std::string words;
    for (const FileFinding& finding : report.findings)
        words += on_one_line(finding.path) + ": " + on_one_line(finding.message) + "\n";
    if (report.findings.empty())
        words += on_one_line(report.manifest.design) + ", release " +
                 std::to_string(report.manifest.release) + " for " + on_one_line(report.manifest.loom) +
                 ": " + counted(report.manifest.files.size(), "file") + ", every byte as it was signed\n";
    if (!knows_recalls)
        words += "Whether it was recalled since only a terminal's state or the server knows.\n";
    return words;
}

Status verify(const VerifyWords& words, CommandOutcome& outcome) {
    WEAVE_TRY(const Believed who, believed(words));
    WEAVE_TRY(const FolderReport report, verify_files(words.folder, who.trust));
    const Status recall = who.state ? check_recall(*who.state, report.manifest) : Status();
    outcome.answer(report_json(report, recall, who.state.has_value()),
                   report_words(report, who.state.has_value()));
    if (!recall) return recall;
    if (!report.findings.empty()) outcome.found_something();
    return {};
}

}  // namespace

void add_verify_files_command(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* const command = add_command(
        app, outcome, "verify-files",
        "Prove offline that the files of a release are what people signed; exit status 1 where one is not, "
        "or "
        "the manifest itself is not, 3 where the folder has no manifest, 4 where the release was recalled",
        "loomlink verify-files /loom/release-5-0a1b2c3d4e5f --loom 'EP 1'");
    const auto words = std::make_shared<VerifyWords>();
    add_text(command, "FOLDER", words->folder, "the folder of the release, with its manifest.json")
        ->required();
    add_text(command, "--state", words->state_file, "what the terminal trusts and has seen (pull --state)")
        ->type_name("FILE");
    add_loom_name(command, "--loom", words->loom, "the same, of this loom, where pull keeps it")
        ->type_name("LOOM");
    add_text(command, "--trust", words->trust_file, "a trust document, as trust show -o wrote it")
        ->type_name("FILE");
    on_run(command, outcome, [words, &outcome] { return verify(*words, outcome); });
}

}  // namespace weave::loomlink
