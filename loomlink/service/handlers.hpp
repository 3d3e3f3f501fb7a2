#pragma once

#include <loomlink/service/table.hpp>
#include <loomlink/service/watchers.hpp>
#include <loomlink/workflow/workflow.hpp>

namespace weave::loomlink {

// What answers the lines of the table, subject by subject. The workflow must outlive the handlers.

/// Accounts, people and the policy.
void add_account_handlers(ApiHandlers& handlers, Accounts& accounts);
/// Designs and revisions, to read and to save.
void add_design_handlers(ApiHandlers& handlers, DesignDesk& designs);
/// What is done to a revision.
void add_step_handlers(ApiHandlers& handlers, Steps& steps);
/// Machines that sign, and what they hand in.
void add_evidence_handlers(ApiHandlers& handlers, EvidenceDesk& evidence);
/// Looms; who watches one is told of a new profile.
void add_loom_handlers(ApiHandlers& handlers, LoomDesk& looms, const Watchers& watchers);
/// Releases; who watches their loom is told of each change.
void add_release_handlers(ApiHandlers& handlers, ReleaseDesk& releases, const Watchers& watchers);
/// Whose keys count; all who watch a loom are told of a new document.
void add_trust_handlers(ApiHandlers& handlers, TrustChain& trust, const Watchers& watchers);
/// The log and its proofs.
void add_audit_handlers(ApiHandlers& handlers, AuditDesk& audit);
/// Everything about a revision in one document.
void add_bundle_handler(ApiHandlers& handlers, DesignDesk& designs, AuditDesk& audit);
/// Who may see a loom may watch it, as long as the sign-in lasts.
void add_watch_handler(ApiHandlers& handlers, Workflow& workflow, const Watchers& watchers);

/// All of them.
ApiHandlers workflow_handlers(Workflow& workflow, const Watchers& watchers);

}  // namespace weave::loomlink
