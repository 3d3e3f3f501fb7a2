#include <weave/core/json_reader.hpp>
#include <weave/keys/members.hpp>
#include <weave/keys/signed_document.hpp>
#include <weave/wire/evidence.hpp>

#include <utility>

namespace weave::wire {

namespace {

constexpr const char* format = "weave-signed-evidence";
constexpr std::size_t key_characters = 64, value_characters = 128;

Signature read_signature(JsonReader reader) {
    Signature signature{hex_member(reader, "key", key_characters), hex_member(reader, "value", value_characters)};
    reader.no_others();
    return signature;
}

}  // namespace

Result<SignedEvidence> sign_evidence(const KeyPair& key, const std::string& site, std::string report, Instant at) {
    WEAVE_TRY(SimulationStatement statement, statement_of_result(report, at));
    statement.site = site;
    Json body = statement_body(statement);
    WEAVE_CHECK_OK(read_simulation(body));  // such as a site that is no name
    Signature signature = sign_body(key, Purpose::evidence, body);
    return SignedEvidence{std::move(body), std::move(signature), std::move(report)};
}

std::string write_evidence(const SignedEvidence& evidence) {
    const Signature& signature = evidence.signature;
    return canonical_json({{"format", format},
                           {"version", 1},
                           {"statement", evidence.statement},
                           {"signature", {{"key", signature.key}, {"value", signature.value}}},
                           {"report", evidence.report}});
}

Result<SignedEvidence> read_evidence(std::string_view bytes) {
    if (bytes.size() > most_evidence) return bad_input("is too large: signed evidence has at most 16 MiB");
    WEAVE_TRY(const Json json, parse_json(bytes));
    if (canonical_json(json) != bytes)
        return bad_input("is not in canonical form (RFC 8785), so that its bytes could mean more than was signed");
    JsonReader reader(json, "");
    read_heading(reader, format);
    SignedEvidence evidence;
    evidence.statement = reader.object("statement").json();
    evidence.signature = read_signature(reader.object("signature"));
    evidence.report = reader.text("report", {}, most_report);
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    WEAVE_TRY(const SimulationStatement statement, read_simulation(evidence.statement));
    if (sha256(evidence.report) != statement.report_sha256) return bad_input("is not the report that was signed", "report");
    return evidence;
}

bool is_evidence(const Json& document) {
    return document.is_object() && document.contains("format") && document.at("format") == format;
}

}  // namespace weave::wire
