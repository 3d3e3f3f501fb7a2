#include <loomlink/commands/verify_audit.hpp>

#include <weave/core/file.hpp>
#include <weave/core/text.hpp>

#include <loomlink/audit/bundle.hpp>
#include <loomlink/audit/told_keys.hpp>
#include <loomlink/commands/finding_words.hpp>
#include <loomlink/commands/head_keeper.hpp>
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

/// How many signatures of statements were judged by keys of which kind.
struct JudgedSignatures {
    std::size_t listed = 0;      ///< the trust document lists the key, for this very person
    std::size_t log_alone = 0;   ///< only the log tells whose key it is
};

using Judged = std::shared_ptr<JudgedSignatures>;

/// Statements by the keys that the log itself hands out, each for its holder alone; where there is a trust
/// document, it must not name another holder.
SignatureCheck by_told_keys(std::map<std::string, ToldPublicKey> keys, std::optional<TrustDocument> trust,
                            const Judged& judged) {
    return [keys = std::move(keys), trust = std::move(trust), judged](std::string_view bytes,
                                                                      const RecordSignature& signature) {
        const auto told = keys.find(signature.key);
        const auto statement = parse_json(bytes);
        if (told == keys.end() || !statement || statement->at("actor") != told->second.holder) return false;
        const TrustedKey* listed = trust ? trust->find(signature.key) : nullptr;
        if (listed != nullptr && listed->person != told->second.holder) return false;
        ++(listed != nullptr ? judged->listed : judged->log_alone);
        return is_good(told->second.key, Purpose::statement, bytes, signature);
    };
}

/// Heads signed by a key with the role `log`.
SignatureCheck by_log_keys(const TrustDocument& trust) {
    return [trust](std::string_view bytes, const RecordSignature& signature) {
        const TrustedKey* key = trust.find(signature.key);
        return key != nullptr && key->has(Role::log) &&
               is_good(key->public_key, Purpose::tree_head, bytes, signature);
    };
}

Result<SignedTreeHead> as_tree_head(const SignedLogHead& head) {
    return parse_signed_head(canonical_json(to_json(head)));
}

/// What is trusted, by the one of --key, --trust and --state that was given.
Result<BundleTrust> wished_trust(const VerifyWords& words, std::string_view bundle, const Judged& judged) {
    BundleTrust trust;
    std::optional<TrustDocument> document;
    if (!words.key.empty()) {
        auto parsed = parse_public_key(words.key);
        if (!parsed) return std::move(parsed).error().in("--key");
        trust.log = [key = *parsed](std::string_view bytes, const RecordSignature& signature) {
            return is_good(key, Purpose::tree_head, bytes, signature);
        };
    } else if (!words.trust_file.empty()) {
        WEAVE_TRY(const std::string bytes, read_file(words.trust_file, most_trust_bytes));
        auto read = read_trust(bytes);
        if (!read) return std::move(read).error().in(words.trust_file);
        document = *std::move(read);
    } else {
        WEAVE_TRY(const TerminalState state, load_state(words.state_file));
        document = state.trust;
        if (state.tree_head) {
            WEAVE_TRY(trust.retained, as_tree_head(*state.tree_head));
        }
    }
    if (document) trust.log = by_log_keys(*document);
    trust.statements = by_told_keys(told_keys(bundle), document, judged);
    return trust;
}

Json report_json(const BundleReport& report, const JudgedSignatures& judged, bool retained) {
    Json head = nullptr;
    if (report.head)
        head = {{"site", report.head->head.site},
                {"size", report.head->head.size},
                {"root", hash_hex(report.head->head.root)},
                {"at", report.head->head.at}};
    return {{"clean", report.clean()},           {"records", report.records},
            {"head", std::move(head)},           {"retained", retained},
            {"signatures_by_listed_keys", judged.listed},
            {"signatures_by_keys_of_the_log", judged.log_alone},
            {"findings", findings_json(report.findings)},
            {"unlisted", report.unlisted}};
}

std::string report_words(const BundleReport& report, const JudgedSignatures& judged, bool retained) {
    std::string words = findings_words(report.findings);
    if (report.unlisted > 0) words += "… and " + counted(report.unlisted, "finding") + " more\n";
    if (report.clean())
        words += counted(report.records, "record") + ": nothing was changed, removed or reordered\n";
    if (!retained) words += "Without a head kept from earlier an older copy of the log cannot be told.\n";
    words += counted(judged.listed + judged.log_alone, "signature") +
             " of people were held to the keys with which they joined";
    if (judged.log_alone > 0)
        words += "; for " + std::to_string(judged.log_alone) + " of them the log alone tells whose key it is";
    words += ".\n";
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
    WEAVE_TRY(const std::string bundle, read_file(words.bundle));
    const Judged judged = std::make_shared<JudgedSignatures>();
    WEAVE_TRY(BundleTrust trust, wished_trust(words, bundle, judged));
    if (!words.retained_file.empty()) {
        WEAVE_TRY(trust.retained, load_retained_head(words.retained_file));
    }
    const BundleReport report = verify_bundle(bundle, trust);
    const bool retained = trust.retained.has_value();
    outcome.answer(report_json(report, *judged, retained), report_words(report, *judged, retained));
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
             "a trust document, as trust show -o wrote it: it must name the same holders of keys as the log")
        ->type_name("FILE");
    add_text(command, "--state", words->state_file,
             "what a loom's terminal trusts and has seen (pull --state)")
        ->type_name("FILE");
    add_text(command, "--retained", words->retained_file,
             "a head kept from earlier, as audit head -o wrote it or the server in a second place: an older "
             "copy is found out")
        ->type_name("FILE");
    on_run(command, outcome, [words, &outcome] { return verify_audit(*words, outcome); });
}

}  // namespace weave::loomlink
