// evidence: what simulations found, signed by an enrolled machine.

#include <weave/core/file.hpp>
#include <weave/keys/server_key.hpp>
#include <weave/wire/mill_designs.hpp>

#include <loomlink/commands/client_command.hpp>
#include <loomlink/commands/evidence_file.hpp>
#include <loomlink/commands/revision_place.hpp>
#include <loomlink/commands/trust_papers.hpp>
#include <loomlink/workflow/desk.hpp>

namespace weave::loomlink {

namespace {

struct EvidenceWords {
    std::string file, key_file;
};

/// The site that a statement is for: the one that this machine is enrolled at, or that of the server's trust
/// document.
Result<std::string> site_of(wire::MillClient& client) {
    if (!client.session().site.empty()) return client.session().site;
    WEAVE_TRY(const TrustDocument trust, newest_trust_of(client));
    return trust.site;
}

/// Signs the answer of `weave simulate --json` with the machine's key.
Result<EvidenceToFile> signed_now(wire::MillClient& client, std::string report, const EvidenceWords& words) {
    if (words.key_file.empty())
        return Error{ErrorCode::usage, "a result that is not signed yet takes the machine's key: --key-file", words.file};
    WEAVE_TRY(const KeyPair key, load_server_key(words.key_file, ServerKeyRole::evidence));
    WEAVE_TRY(const std::string site, site_of(client));
    auto evidence = wire::sign_evidence(key, site, std::move(report), system_clock()());
    if (!evidence) return std::move(evidence).error().in(words.file);
    WEAVE_TRY(wire::SimulationStatement statement, wire::read_simulation(evidence->statement));
    return EvidenceToFile{*std::move(evidence), std::move(statement)};
}

/// What a file holds, by what it says of itself: evidence that is signed, or a result that is signed here.
Result<EvidenceToFile> evidence_of(wire::MillClient& client, const EvidenceWords& words) {
    WEAVE_TRY(std::string bytes, read_file(words.file, wire::most_evidence));
    const auto json = parse_json(bytes);
    if (!json) return Error(json.error()).in(words.file);
    if (!wire::is_evidence(*json)) return signed_now(client, std::move(bytes), words);
    if (!words.key_file.empty())
        return Error{ErrorCode::usage, "is signed already, by the machine that simulated", words.file};
    auto evidence = evidence_from(bytes);
    if (!evidence) return std::move(evidence).error().in(words.file);
    return evidence;
}

Status add_evidence(wire::MillClient& client, const RevisionPlace& place, const EvidenceWords& words,
                    CommandOutcome& outcome) {
    WEAVE_TRY(const EvidenceToFile filed, evidence_of(client, words));
    WEAVE_TRY(Json number, wire::file_evidence(client, place.design, place.revision(), filed.evidence));
    outcome.answer({{"evidence", std::move(number)}, {"statement", filed.evidence.statement}},
                   place.words() + ": " + filed.words() + "\n");
    return {};
}

void add_add(CLI::App& app, CommandOutcome& outcome) {
    const auto command =
        add_client_command(app, outcome, "add",
                           "File what a simulation found for a revision: evidence that a machine has signed, or a result "
                           "that this machine signs now",
                           "loomlink evidence add shoe 3 shoe.evidence; weave simulate shoe.weave -o shoe.yarns --json > "
                           "result.json; loomlink evidence add shoe 3 result.json --key-file evidence.key");
    const auto place = add_revision_place(command.command);
    const auto words = std::make_shared<EvidenceWords>();
    add_text(command.command, "FILE", words->file, "signed evidence, or what weave simulate --json answered")->required();
    add_text(command.command, "--key-file", words->key_file,
             "for a result that is not signed: the machine's key, as signer enrol made it")
        ->type_name("FILE");
    on_client_run(command, outcome, [place, words, &outcome](wire::MillClient& client) {
        return add_evidence(client, *place, *words, outcome);
    });
}

Status list_evidence(wire::MillClient& client, const RevisionPlace& place, CommandOutcome& outcome) {
    WEAVE_TRY(const Json revision, client.get(place.path()));
    const Json answer{{"evidence", entries(revision, "evidence")}};
    outcome.answer(answer,
                   as_list(in_columns(answer, "evidence", {"kind", "covers", "result", "signer", "at", "stale"})));
    return {};
}

}  // namespace

void add_evidence_commands(CLI::App& app, CommandOutcome& outcome) {
    CLI::App& evidence = add_group(app, "evidence", "What validation and simulations found about a revision");
    add_add(evidence, outcome);
    const auto list = add_client_command(evidence, outcome, "list", "List it, and what is stale and why");
    const auto place = add_revision_place(list.command);
    on_client_run(list, outcome,
                  [place, &outcome](wire::MillClient& client) { return list_evidence(client, *place, outcome); });
}

}  // namespace weave::loomlink
