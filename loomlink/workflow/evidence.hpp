#pragma once

#include <weave/core/json.hpp>
#include <weave/wire/evidence.hpp>

#include <cstddef>
#include <loomlink/workflow/desk.hpp>
#include <loomlink/workflow/policy.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace weave::loomlink {

/// The row that the store keeps of a statement, signed by the machine whose key `signer` names.
Evidence evidence_row(const wire::SimulationStatement& statement, const std::string& signer, Seq event);

/// Simulation evidence that speaks of a revision, or spoke of another one of its design.
struct KnownSimulation {
    Evidence evidence;
    std::vector<wire::SimulatedRegion> regions;
    bool order_kept = false;
    std::string result_sha256;  ///< of the .yarns file
    std::string signer, at;     ///< name of the machine; when it was filed
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
