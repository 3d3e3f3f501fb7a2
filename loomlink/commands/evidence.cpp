// evidence: what simulations found, signed by an enrolled machine.

#include <weave/core/file.hpp>
#include <weave/core/text.hpp>

#include <loomlink/commands/client_command.hpp>
#include <loomlink/commands/revision_place.hpp>
#include <loomlink/commands/simulation_result.hpp>
#include <loomlink/commands/trust_papers.hpp>
#include <loomlink/keys/server_key.hpp>

namespace weave::loomlink {

namespace {

constexpr std::uint64_t most_report = std::uint64_t{4} << 20;

struct EvidenceWords {
    std::string result, key_file;
};

/// The site that a statement is for: the one that this machine is enrolled at, or that of the server's trust
/// document.
Result<std::string> site_of(ApiClient& client) {
    if (!client.session().site.empty()) return client.session().site;
    WEAVE_TRY(const TrustDocument trust, newest_trust_of(client));
    return trust.site;
}

Status add_evidence(ApiClient& client, const RevisionPlace& place, const EvidenceWords& words,
                    CommandOutcome& outcome) {
    WEAVE_TRY(const KeyPair key, load_server_key(words.key_file, ServerKeyRole::evidence));
    WEAVE_TRY(std::string report, read_file(words.result, most_report));
    auto statement = statement_of_result(report);
    if (!statement) return std::move(statement).error().in(words.result);
    WEAVE_TRY(statement->site, site_of(client));
    const Json body = statement_body(*statement);
    const Signature signature = key.sign(Purpose::evidence, canonical_json(body));
    WEAVE_TRY(const Json answer,
              client.post(place.path("evidence"),
                          {{"statement", body},
                           {"signature", {{"key", signature.key}, {"value", signature.value}}},
                           {"report", std::move(report)}}));
    outcome.answer({{"evidence", answer.value("evidence", Json())}, {"statement", body}},
                   place.words() + ": a simulation at " + on_one_line(statement->fidelity) +
                       (statement->converged ? ", at rest" : ", NOT at rest") +
                       (statement->order_kept ? "" : ", crossings changed") + "\n");
    return {};
}

void add_add(CLI::App& app, CommandOutcome& outcome) {
    const auto command =
        add_client_command(app, outcome, "add", "Sign the result of a simulation and file it for a revision",
                           "weave simulate shoe.weave -o shoe.yarns --json > result.json; loomlink evidence "
                           "add shoe 3 result.json "
                           "--key-file evidence.key");
    const auto place = add_revision_place(command.command);
    const auto words = std::make_shared<EvidenceWords>();
    add_text(command.command, "RESULT", words->result, "what weave simulate --json answered")->required();
    add_text(command.command, "--key-file", words->key_file, "the machine's key, as signer enrol made it")
        ->type_name("FILE")
        ->required();
    on_client_run(command, outcome, [place, words, &outcome](ApiClient& client) {
        return add_evidence(client, *place, *words, outcome);
    });
}

Status list_evidence(ApiClient& client, const RevisionPlace& place, CommandOutcome& outcome) {
    WEAVE_TRY(const Json revision, client.get(place.path()));
    const Json answer{{"evidence", entries(revision, "evidence")}};
    outcome.answer(answer,
                   in_columns(answer, "evidence", {"kind", "covers", "result", "signer", "at", "stale"}));
    return {};
}

}  // namespace

void add_evidence_commands(CLI::App& app, CommandOutcome& outcome) {
    CLI::App& evidence = add_group(app, "evidence", "What validation and simulations found about a revision");
    add_add(evidence, outcome);
    const auto list = add_client_command(evidence, outcome, "list", "List it, and what is stale and why");
    const auto place = add_revision_place(list.command);
    on_client_run(list, outcome,
                  [place, &outcome](ApiClient& client) { return list_evidence(client, *place, outcome); });
}

}  // namespace weave::loomlink
