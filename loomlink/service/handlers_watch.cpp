#include <loomlink/service/gate.hpp>
#include <loomlink/service/handlers.hpp>
#include <loomlink/workflow/found.hpp>

namespace weave::loomlink {

void add_watch_handler(ApiHandlers& handlers, Desk& desk, Accounts& accounts, const Watchers& watchers) {
    const auto sees = [&desk](const Caller& caller, const std::string& loom) -> Status {
        const auto found =
            desk.store().read([&](const Reader& reader) { return find_loom(reader, caller, loom); });
        return found ? Status() : Status(found.error());
    };
    handlers.sockets["loom.watch"] = [&accounts, watchers,
                                      sees](const ApiCall& call) -> net::WebSocketAdmission {
        const std::string& loom = call.place("loom");
        if (const Status seen = sees(call.visitor.caller(), loom); !seen) return trouble_answer(seen.error());
        return watchers.watch(loom, [&accounts, sees, loom, token = call.visitor.token] {
            const auto who = accounts.who(token);
            return who && sees(who->caller, loom);
        });
    };
}

}  // namespace weave::loomlink
