#pragma once

#include <loomlink/workflow/accounts.hpp>
#include <loomlink/workflow/audit_desk.hpp>
#include <loomlink/workflow/designs.hpp>
#include <loomlink/workflow/evidence.hpp>
#include <loomlink/workflow/looms.hpp>
#include <loomlink/workflow/releases.hpp>
#include <loomlink/workflow/steps.hpp>
#include <loomlink/workflow/trust_chain.hpp>
#include <loomlink/workflow/waiting.hpp>
#include <memory>
#include <string>

namespace weave::loomlink {

/// Everything that people and machines may do with a store, a class a subject. Any thread may call; it must
/// outlive the calls.
class Workflow {
  public:
    /// Opens a store that Store::create made, with the server's keys.
    static Result<std::unique_ptr<Workflow>> open(Store store, ServerKeys keys,
                                                  const DeskSettings& settings = {},
                                                  NowClock clock = system_clock());
    Workflow(const Workflow&) = delete;
    Workflow& operator=(const Workflow&) = delete;

    [[nodiscard]] Accounts& accounts() { return m_accounts; }
    [[nodiscard]] DesignDesk& designs() { return m_designs; }
    [[nodiscard]] Steps& steps() { return m_steps; }
    [[nodiscard]] EvidenceDesk& evidence() { return m_evidence; }
    [[nodiscard]] LoomDesk& looms() { return m_looms; }
    [[nodiscard]] ReleaseDesk& releases() { return m_releases; }
    [[nodiscard]] TrustChain& trust() { return m_trust; }
    [[nodiscard]] AuditDesk& audit() { return m_audit; }
    /// What waits for this person.
    Result<Json> waiting(const Caller& caller) { return waiting_for(m_desk, caller); }
    /// Logs that an attempt of somebody who is signed in was refused before it came to the workflow, and
    /// gives the error back.
    Error refuse(const Caller& caller, const std::string& request, const Deed& attempt, Error error) {
        return m_desk.refuse(caller, request, attempt, std::move(error));
    }
    /// The newest signed head of the log.
    Result<SignedTreeHead> log_head() { return current_head(m_desk); }
    [[nodiscard]] Store& store() { return m_desk.store(); }

  private:
    Workflow(Store store, ServerKeys keys, std::string site, const DeskSettings& settings, NowClock clock);

    Desk m_desk;
    ClothShelf m_shelf;
    Accounts m_accounts{m_desk};
    DesignDesk m_designs{m_desk, m_shelf};
    Steps m_steps{m_desk, m_shelf};
    EvidenceDesk m_evidence{m_desk};
    LoomDesk m_looms{m_desk};
    ReleaseDesk m_releases{m_desk, m_shelf};
    TrustChain m_trust{m_desk};
    AuditDesk m_audit{m_desk};
};

}  // namespace weave::loomlink
