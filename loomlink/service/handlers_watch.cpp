#include <loomlink/service/answering.hpp>
#include <loomlink/service/gate.hpp>
#include <loomlink/service/handlers.hpp>
#include <loomlink/workflow/found.hpp>

namespace weave::loomlink {

void add_watch_handler(ApiHandlers& handlers, Workflow& workflow, const Watchers& watchers) {
    const auto sees = [&workflow](const Caller& caller, const std::string& loom) -> Status {
        const auto found =
            workflow.store().read([&](const Reader& reader) { return find_loom(reader, caller, loom); });
        return found ? Status() : Status(found.error());
    };
    handlers.sockets["loom.watch"] = [&workflow, watchers,
                                      sees](const ApiCall& call) -> net::WebSocketAdmission {
        const std::string& loom = call.place("loom");
        const Caller& caller = call.visitor.caller();
        if (const Status seen = sees(caller, loom); !seen)
            return trouble_answer(workflow.refuse(caller, {}, {"loom.watched", loom}, seen.error()));
        return watchers.watch(loom, [&workflow, sees, loom, token = call.visitor.token] {
            const auto who = workflow.accounts().who(token);
            return who && sees(who->caller, loom);
        });
    };
}

ApiHandlers workflow_handlers(Workflow& workflow, const Watchers& watchers) {
    ApiHandlers all;
    add_account_handlers(all, workflow.accounts());
    add_design_handlers(all, workflow.designs());
    add_step_handlers(all, workflow.steps());
    add_evidence_handlers(all, workflow.evidence());
    add_loom_handlers(all, workflow.looms(), watchers);
    add_release_handlers(all, workflow.releases(), watchers);
    add_trust_handlers(all, workflow.trust(), watchers);
    add_audit_handlers(all, workflow.audit());
    add_bundle_handler(all, workflow.designs(), workflow.audit());
    all.answers["me.waiting"] =
        answering([&workflow](const ApiCall& call) { return workflow.waiting(call.visitor.caller()); });
    add_watch_handler(all, workflow, watchers);
    return all;
}

}  // namespace weave::loomlink
