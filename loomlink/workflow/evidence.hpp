#pragma once

#include <weave/core/json.hpp>

#include <cstddef>
#include <loomlink/workflow/desk.hpp>
#include <loomlink/workflow/policy.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace weave::loomlink {

/// A part of a cloth that was simulated, from 0, ends excluded; wholly on the card.
struct SimulatedRegion {
    std::size_t first_pick = 0, picks = 0, first_end = 0, ends = 0;
};

/// What a simulation says that it found: the body that a signer signs.
struct SimulationStatement {
    std::string site;
    Hash design_sha256{}, scene_sha256{}, report_sha256{};
    std::size_t picks = 0, ends = 0;       ///< of the whole cloth
    std::vector<SimulatedRegion> regions;  ///< none: the whole
    std::string fidelity, solver;
    Json parameters = Json::object();
    std::optional<double> residual;  ///< none where it was not finite
    bool converged = false, order_kept = false;
    std::string at;
};

/// The body; `coverage` is told beside the regions and must be theirs.
Json statement_body(const SimulationStatement& statement);
/// Reads what statement_body() makes, and nothing else.
Result<SimulationStatement> read_simulation(const Json& body);

/// The row that the store keeps of a statement, signed by the machine whose key `signer` names.
Evidence evidence_row(const SimulationStatement& statement, const std::string& signer, Seq event);

/// The share of a card that regions cover together, wherever they overlap.
double covered_share(const std::vector<SimulatedRegion>& regions, std::size_t picks, std::size_t ends);

/// Simulation evidence that speaks of a revision, or spoke of another one of its design.
struct KnownSimulation {
    Evidence evidence;
    std::vector<SimulatedRegion> regions;
    bool order_kept = false;
    std::string signer, at;  ///< name of the machine; when it was filed
    std::string stale;       ///< why it does not count; empty: it does
};
/// All of a design's, those about this very revision first.
Result<std::vector<KnownSimulation>> simulations_of(const Reader& reader, const Revision& revision);
/// What the simulations that count still lack under this policy, in words.
std::vector<std::string> missing_simulation(const std::vector<KnownSimulation>& known,
                                            const Revision& revision, const SitePolicy& policy);

/// Machines that sign what simulations found, and what they hand in.
class EvidenceDesk {
  public:
    explicit EvidenceDesk(Desk& desk) : m_desk(&desk) {}

    /// `code`, `expires`: for a machine to enrol with, told once.
    Result<Json> invite_signer(const Caller& caller, const Ask& ask, const std::string& name);
    /// `name`, `key`, and the `site` that the machine signs for.
    Result<Json> enrol(const std::string& code, const std::string& public_key, const std::string& address);
    Result<Json> revoke_signer(const Caller& caller, const Ask& ask, const std::string& name);
    /// `signers`: of each `name`, `key`, `revoked`.
    Result<Json> signers(const Caller& caller);

    /// Files evidence for a revision. The signature is what authorises, whoever hands it in. `report` are the
    /// bytes whose hash was signed; empty where the store has them.
    Result<Json> add(const std::string& design, std::int64_t number, const std::string& request,
                     const Json& statement, const Signature& signature, std::string_view report);

  private:
    Desk* m_desk;
};

}  // namespace weave::loomlink
