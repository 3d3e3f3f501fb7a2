// verify-files: whether what lies at a loom is what people signed, without any server.

#include <weave/core/exit_code.hpp>
#include <weave/core/file.hpp>
#include <weave/core/text.hpp>

#include <loomlink/commands/command.hpp>
#include <loomlink/commands/names.hpp>
#include <loomlink/commands/puller.hpp>
#include <loomlink/commands/trust_papers.hpp>
#include <memory>

namespace weave::loomlink {

namespace {

struct VerifyWords {
    std::string folder, state_file, loom, trust_file, fingerprint;
};

/// Whom to believe, and, where a terminal knows it, what became of the releases.
struct Believed {
    TrustDocument trust;
    std::optional<TerminalState> state;
};

Result<TerminalState> state_of(const VerifyWords& words) {
    std::filesystem::path file = words.state_file;
    if (file.empty()) {
        WEAVE_TRY(file, usual_state_file(words.loom));
        if (std::error_code code; !std::filesystem::exists(file, code))
            return bad_input("this terminal has pulled nothing for it yet: say --trust FILE (trust show -o) and --fingerprint, or pull first", words.loom);
    }
    return load_state(file);
}

Result<Believed> believed(const VerifyWords& words) {
    if (!words.trust_file.empty() && !words.fingerprint.empty() && words.state_file.empty()) {
        WEAVE_TRY(TrustDocument trust, trust_from_file(words.trust_file, words.fingerprint));
        return Believed{std::move(trust), {}};
    }
    const bool by_paper = !words.trust_file.empty() || !words.fingerprint.empty();
    if (by_paper || words.state_file.empty() == words.loom.empty())
        return Error{ErrorCode::usage, "say whom to believe: --loom, --state, or --trust with --fingerprint", ""};
    WEAVE_TRY(TerminalState state, state_of(words));
    TrustDocument trust = state.trust;
    return Believed{std::move(trust), std::move(state)};
}

/// What is known against weaving it here.
Status check_here(const Believed& who, const std::string& loom, const ReleaseManifest& manifest) {
    if (who.state) return check_recall(*who.state, manifest);
    if (loom.empty() || loom == manifest.loom) return {};
    return Error{ErrorCode::refused, "release " + std::to_string(manifest.release) + " is for the loom '" + manifest.loom + "', not for '" + loom + "'", "manifest"};
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
    const Status recall = check_here(who, words.loom, report.manifest);
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
        "or the manifest or the trust document itself is not, 3 where the folder has no manifest, 4 where the release was "
        "recalled or is for another loom",
        "loomlink verify-files /loom/release-5-0a1b2c3d4e5f --loom 'EP 1'");
    const auto words = std::make_shared<VerifyWords>();
    add_text(command, "FOLDER", words->folder, "the folder of the release, with its manifest.json")
        ->required();
    add_text(command, "--state", words->state_file, "what the terminal trusts and has seen (pull --state)")
        ->type_name("FILE");
    add_loom_name(command, "--loom", words->loom, "the same, of this loom, where pull keeps it; with --trust: the loom that the release has to be for")
        ->type_name("LOOM");
    add_text(command, "--trust", words->trust_file, "on a machine that never pulled: the mill's trust document, as trust show -o wrote it")
        ->type_name("FILE");
    add_text(command, "--fingerprint", words->fingerprint, "of that document, as an administrator told it another way")
        ->type_name("HEX");
    on_run(command, outcome, [words, &outcome] { return verify(*words, outcome); });
}

}  // namespace weave::loomlink
