#include <weave/core/file.hpp>
#include <weave/core/text.hpp>

#include <loomlink/audit/bundle.hpp>
#include <loomlink/commands/finding_words.hpp>
#include <loomlink/commands/verify_audit.hpp>
#include <loomlink/terminal/state.hpp>
#include <memory>

namespace weave::loomlink {

namespace {

struct VerifyWords {
    std::string bundle, key, trust_file, state_file, retained_file;
};

bool is_good(const PublicKey& key, Purpose purpose, std::string_view bytes,
             const RecordSignature& signature) {
    return verify(key, purpose, bytes, {signature.key, signature.value});
}

/// Heads signed by a key with the role `log`, statements by whom the document knows. Designers and engineers
/// release nothing and so are in no trust document: their signatures cannot be judged by it, and are counted
/// in `unjudged`.
BundleTrust trust_of(const TrustDocument& trust, const std::shared_ptr<std::size_t>& unjudged) {
    BundleTrust made;
    made.log = [trust](std::string_view bytes, const RecordSignature& signature) {
        const TrustedKey* key = trust.find(signature.key);
        return key != nullptr && key->has(Role::log) &&
               is_good(key->public_key, Purpose::tree_head, bytes, signature);
    };
    made.statements = [trust, unjudged](std::string_view bytes, const RecordSignature& signature) {
        const TrustedKey* key = trust.find(signature.key);
        if (key != nullptr) return is_good(key->public_key, Purpose::statement, bytes, signature);
        ++*unjudged;
        return true;
    };
    return made;
}

Result<SignedTreeHead> as_tree_head(const SignedLogHead& head) {
    return parse_signed_head(canonical_json(to_json(head)));
}

/// What is trusted, by the one of --key, --trust and --state that was given.
Result<BundleTrust> wished_trust(const VerifyWords& words, const std::shared_ptr<std::size_t>& unjudged) {
    if (!words.key.empty()) {
        auto parsed = parse_public_key(words.key);
        if (!parsed) return std::move(parsed).error().in("--key");
        BundleTrust trust;
        trust.log = [key = *parsed](std::string_view bytes, const RecordSignature& signature) {
            return is_good(key, Purpose::tree_head, bytes, signature);
        };
        return trust;
    }
    if (!words.trust_file.empty()) {
        WEAVE_TRY(const std::string bytes, read_file(words.trust_file, most_trust_bytes));
        const auto document = read_trust(bytes);
        if (!document) return Error(document.error()).in(words.trust_file);
        return trust_of(*document, unjudged);
    }
    WEAVE_TRY(const TerminalState state, load_state(words.state_file));
    BundleTrust trust = trust_of(state.trust, unjudged);
    if (state.tree_head) {
        WEAVE_TRY(trust.retained, as_tree_head(*state.tree_head));
    }
    return trust;
}

Json report_json(const BundleReport& report, std::size_t unjudged, bool retained) {
    Json head = nullptr;
    if (report.head)
        head = {{"site", report.head->head.site},
                {"size", report.head->head.size},
                {"root", hash_hex(report.head->head.root)},
                {"at", report.head->head.at}};
    return {{"clean", report.clean()},           {"records", report.records},
            {"head", std::move(head)},           {"retained", retained},
            {"signatures_not_judged", unjudged}, {"findings", findings_json(report.findings)},
            {"unlisted", report.unlisted}};
}

std::string report_words(const BundleReport& report, std::size_t unjudged, bool retained) {
    std::string words = findings_words(report.findings);
    if (report.unlisted > 0) words += "… and " + counted(report.unlisted, "finding") + " more\n";
    if (report.clean())
        words += counted(report.records, "record") + ": nothing was changed, removed or reordered\n";
    if (!retained) words += "Without a head kept from earlier an older copy of the log cannot be told.\n";
    if (unjudged > 0)
        words += counted(unjudged, "signature") + " of people whose keys the trust document does not list " +
                 "could not be judged.\n";
    return words;
}

/// Somebody has to be believed, and one at a time.
Status check_words(const VerifyWords& words) {
    const int given =
        int(!words.key.empty()) + int(!words.trust_file.empty()) + int(!words.state_file.empty());
    if (given == 1) return {};
    return Error{ErrorCode::usage, "say whose key to believe: one of --key, --trust and --state", ""};
}

Status verify_audit(const VerifyWords& words, CommandOutcome& outcome) {
    WEAVE_CHECK_OK(check_words(words));
    const auto unjudged = std::make_shared<std::size_t>(0);
    WEAVE_TRY(BundleTrust trust, wished_trust(words, unjudged));
    if (!words.retained_file.empty()) {
        constexpr std::uint64_t most_head = 65536;
        WEAVE_TRY(const std::string bytes, read_file(words.retained_file, most_head));
        const auto head = parse_signed_head(bytes);
        if (!head) return Error(head.error()).in(words.retained_file);
        trust.retained = *head;
    }
    WEAVE_TRY(const std::string bundle, read_file(words.bundle));
    const BundleReport report = verify_bundle(bundle, trust);
    const bool retained = trust.retained.has_value();
    outcome.answer(report_json(report, *unjudged, retained), report_words(report, *unjudged, retained));
    if (!report.clean()) outcome.found_something();
    return {};
}

}  // namespace

void add_audit_verify(CLI::App& audit, CommandOutcome& outcome) {
    CLI::App* const command =
        add_command(audit, outcome, "verify",
                    "Prove offline that a bundle of the log was not changed; exit status 1 where it was, "
                    "with the record's "
                    "number",
                    "loomlink audit verify log.json --trust trust.json --retained head.json");
    const auto words = std::make_shared<VerifyWords>();
    add_text(command, "BUNDLE", words->bundle, "the file that audit bundle wrote")->required();
    add_text(command, "--key", words->key, "the public key of the log, as key list --json tells it")
        ->type_name("HEX");
    add_text(command, "--trust", words->trust_file,
             "a trust document, as trust show -o wrote it: people's signatures are looked at as well")
        ->type_name("FILE");
    add_text(command, "--state", words->state_file,
             "what a loom's terminal trusts and has seen (pull --state)")
        ->type_name("FILE");
    add_text(command, "--retained", words->retained_file,
             "a head kept from earlier, as audit head -o wrote it: an older copy is found out")
        ->type_name("FILE");
    on_run(command, outcome, [words, &outcome] { return verify_audit(*words, outcome); });
}

}  // namespace weave::loomlink
