#include <loomlink/commands/verify_audit.hpp>

#include <weave/core/file.hpp>
#include <weave/core/text.hpp>

#include <loomlink/audit/bundle.hpp>
#include <loomlink/audit/told_keys.hpp>
#include <loomlink/commands/finding_words.hpp>
#include <loomlink/commands/head_keeper.hpp>
#include <loomlink/commands/trust_papers.hpp>
#include <loomlink/terminal/state.hpp>
#include <memory>
#include <set>

namespace weave::loomlink {

namespace {

struct VerifyWords {
    std::string bundle, key, trust_file, fingerprint, state_file, retained_file;
};

bool is_good(const PublicKey& key, Purpose purpose, std::string_view bytes,
             const RecordSignature& signature) {
    return verify(key, purpose, bytes, {signature.key, signature.value});
}

/// How many signatures of statements were judged by keys of which kind, and by whom evidence is.
struct JudgedSignatures {
    std::size_t listed = 0;      ///< the trust document lists the key, for this very person
    std::size_t log_alone = 0;   ///< only the log tells whose key it is
    std::set<std::string> unnamed;  ///< machines that signed evidence and that the trust document does not name
};

using Judged = std::shared_ptr<JudgedSignatures>;

/// The keys that the log itself hands out, each for its holder alone, and the trust document where there is one.
struct KnownKeys {
    ToldPublicKeys told;
    std::optional<TrustDocument> trust;

    [[nodiscard]] const TrustedKey* listed(const std::string& id) const { return trust ? trust->find(id) : nullptr; }
    /// This holder's key of this id; nullptr where the log, or the trust document, knows it for no key or another's.
    [[nodiscard]] const ToldPublicKey* find(const std::string& id, const std::string& holder) const {
        const auto found = told.find(id);
        if (found == told.end() || found->second.holder != holder) return nullptr;
        const TrustedKey* named = listed(id);
        return named == nullptr || named->person == holder ? &found->second : nullptr;
    }
};

SignatureCheck by_known_keys(const KnownKeys& keys, const Judged& judged) {
    return [keys, judged](std::string_view bytes, const RecordSignature& signature) {
        const auto statement = parse_json(bytes);
        const ToldPublicKey* key = statement ? keys.find(signature.key, statement->at("actor").get<std::string>()) : nullptr;
        if (key == nullptr) return false;
        ++(keys.listed(signature.key) != nullptr ? judged->listed : judged->log_alone);
        return is_good(key->key, Purpose::statement, bytes, signature);
    };
}

/// Evidence, whose signature stands in the record beside what it is over. A machine that the trust document does
/// not name is no fault: it may have been enrolled since, or revoked; but it is told.
std::function<bool(const Statement&)> by_known_machines(const KnownKeys& keys, const Judged& judged) {
    return [keys, judged](const Statement& said) {
        const auto text = [&](const char* member) {
            return said.data.contains(member) && said.data.at(member).is_string() ? said.data.at(member).get<std::string>() : "";
        };
        const RecordSignature signature{text("key"), text("signature")};
        const ToldPublicKey* key = keys.find(signature.key, said.actor);
        if (key == nullptr || !said.data.contains("statement")) return false;
        const TrustedKey* listed = keys.listed(signature.key);
        if (listed != nullptr && !listed->has(Role::evidence)) return false;
        if (keys.trust && listed == nullptr) judged->unnamed.insert(said.actor);
        return is_good(key->key, Purpose::evidence, canonical_json(said.data.at("statement")), signature);
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
        WEAVE_TRY(document, trust_from_file(words.trust_file, words.fingerprint));
    } else {
        WEAVE_TRY(const TerminalState state, load_state(words.state_file));
        document = state.trust;
        if (state.tree_head) {
            WEAVE_TRY(trust.retained, as_tree_head(*state.tree_head));
        }
    }
    if (document) trust.log = by_log_keys(*document);
    const KnownKeys keys{told_keys(bundle), std::move(document)};
    trust.statements = by_known_keys(keys, judged);
    trust.evidence = by_known_machines(keys, judged);
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
            {"machines_not_in_trust", judged.unnamed},
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
    for (const std::string& machine : judged.unnamed)
        words += "Evidence is signed by " + on_one_line(machine) +
                 ", whose key the trust document does not name: enrolled since, revoked, or never published.\n";
    return words;
}

/// Somebody has to be believed, and one at a time.
Status check_words(const VerifyWords& words) {
    const int given =
        int(!words.key.empty()) + int(!words.trust_file.empty()) + int(!words.state_file.empty());
    if (given == 1 && words.trust_file.empty() == words.fingerprint.empty()) return {};
    return Error{ErrorCode::usage, "say whose key to believe: --key, --state, or --trust with --fingerprint", ""};
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
                    "loomlink audit verify log.json --trust trust.json --fingerprint TRUST --retained head.json");
    const auto words = std::make_shared<VerifyWords>();
    add_text(command, "BUNDLE", words->bundle, "the file that audit bundle wrote")->required();
    add_text(command, "--key", words->key, "the public key of the log, as key list --json tells it")
        ->type_name("HEX");
    add_text(command, "--trust", words->trust_file,
             "a trust document, as trust show -o wrote it: each key in it must have the holder that the log tells; machines "
             "that signed evidence and are not in it are told")
        ->type_name("FILE");
    add_text(command, "--fingerprint", words->fingerprint, "of that document, as an administrator told it another way")
        ->type_name("HEX");
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
