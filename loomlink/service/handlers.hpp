#pragma once

#include <loomlink/service/table.hpp>
#include <loomlink/service/watchers.hpp>
#include <loomlink/workflow/accounts.hpp>
#include <loomlink/workflow/designs.hpp>
#include <loomlink/workflow/evidence.hpp>
#include <loomlink/workflow/releases.hpp>
#include <loomlink/workflow/steps.hpp>
#include <loomlink/workflow/trust_chain.hpp>

namespace weave::loomlink {

// What answers the lines of the table, subject by subject. The desks must outlive the handlers.

/// Accounts, people and the policy.
void add_account_handlers(ApiHandlers& handlers, Accounts& accounts);
/// Designs and revisions, to read and to save.
void add_design_handlers(ApiHandlers& handlers, DesignDesk& designs);
/// What is done to a revision.
void add_step_handlers(ApiHandlers& handlers, Steps& steps);
/// Machines that sign, and what they hand in.
void add_evidence_handlers(ApiHandlers& handlers, EvidenceDesk& evidence);
/// Releases; who watches their loom is told of each change.
void add_release_handlers(ApiHandlers& handlers, ReleaseDesk& releases, const Watchers& watchers);
/// Whose keys count; all who watch a loom are told of a new document.
void add_trust_handlers(ApiHandlers& handlers, TrustChain& trust, const Watchers& watchers);

/// Who may see a loom may watch it, as long as the sign-in lasts.
void add_watch_handler(ApiHandlers& handlers, Desk& desk, Accounts& accounts, const Watchers& watchers);

}  // namespace weave::loomlink
