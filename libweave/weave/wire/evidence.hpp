#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>
#include <weave/keys/hash.hpp>
#include <weave/keys/key.hpp>
#include <weave/keys/utc.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weave::wire {

/// A part of a cloth that was simulated, from 0, ends excluded; wholly on the card.
struct SimulatedRegion {
    std::size_t first_pick = 0, picks = 0, first_end = 0, ends = 0;
};

/// A line of the plan by which was simulated: what was chosen for a term of the model, and why.
struct StatedChoice {
    std::string term, choice, reason;
};

/// What a simulation says that it found: the body that a machine signs.
struct SimulationStatement {
    std::string site;
    Hash design_sha256{}, scene_sha256{};
    Hash report_sha256{};  ///< of what `weave simulate --json` or a job of simd answered
    Hash result_sha256{};  ///< of the .yarns file
    std::size_t picks = 0, ends = 0;       ///< of the whole cloth
    std::vector<SimulatedRegion> regions;  ///< none: the whole
    std::string fidelity, solver;
    std::vector<StatedChoice> plan;
    Json parameters = Json::object();
    std::optional<double> residual;  ///< none where it was not finite
    bool converged = false, order_kept = false;
    std::string at;
};

/// No statement has more bytes in canonical form.
inline constexpr std::size_t most_statement = 65536;

/// The body; `coverage` is told beside the regions and must be theirs.
Json statement_body(const SimulationStatement& statement);
/// Reads what statement_body() makes, and nothing else.
Result<SimulationStatement> read_simulation(const Json& body);

/// The share of a card that regions cover together, wherever they overlap. Both sizes are 1 or more.
double covered_share(const std::vector<SimulatedRegion>& regions, std::size_t picks, std::size_t ends);

/// No report has more bytes.
inline constexpr std::size_t most_report = std::size_t{4} << 20;

/// What a report says, as a statement made at this moment; `site` is left empty. A report is what `weave simulate
/// --json` answers. A part of a cloth becomes one region of it. The solver's version is that of this program, which is
/// installed with `weave`. Errors (bad_input) name the member.
Result<SimulationStatement> statement_of_result(std::string_view report, Instant at);

/// A statement with the signature of the machine that simulated, and the report whose hash it names: all that loomlink
/// needs to file it, in one file.
struct SignedEvidence {
    Json statement;  ///< the body as it was signed; read_simulation() reads it
    Signature signature;
    std::string report;  ///< every byte of it
};

/// Signs what a report says for a site. Errors as of statement_of_result().
Result<SignedEvidence> sign_evidence(const KeyPair& key, const std::string& site, std::string report, Instant at);

/// `{"format":"weave-signed-evidence","report":…,"signature":{"key":…,"value":…},"statement":…,"version":1}` in
/// canonical form, so that a document has one sequence of bytes.
std::string write_evidence(const SignedEvidence& evidence);

/// No document of it has more bytes: in JSON, quotes and line feeds of a report take two bytes each.
inline constexpr std::size_t most_evidence = 4 * most_report;

/// Reads the form, and whether the report is the one that was signed; who signed is for the caller to check. Refused
/// (bad_input), each in words and at its member: more than most_evidence, bytes that are not in canonical form, other members, a
/// statement that read_simulation() refuses, a report with another hash.
Result<SignedEvidence> read_evidence(std::string_view bytes);

/// Whether a document says of itself that it is signed evidence, so that a program can tell it from a report.
bool is_evidence(const Json& document);

}  // namespace weave::wire
