#include <loomlink/service/answering.hpp>
#include <loomlink/service/handlers.hpp>
#include <optional>

namespace weave::loomlink {

namespace {

constexpr std::size_t usual_limit = 100;

/// The size of the log that a proof is asked for: the one named, or that of its newest head.
Result<std::uint64_t> size_of(const ApiCall& call, AuditDesk& audit) {
    if (call.query.contains("size")) return call.query["size"].get<std::uint64_t>();
    WEAVE_TRY(const Json head, audit.head(call.visitor.caller()));
    return head.at("size").get<std::uint64_t>();
}

std::optional<std::string> design_of(const ApiCall& call) {
    if (!call.query.contains("design")) return {};
    return call.query["design"].get<std::string>();
}

/// All records about a design in the first `size` of the log, each with the way from it to their root.
Result<Json> proven_events(AuditDesk& audit, const Caller& caller, const std::string& design,
                           std::uint64_t size) {
    constexpr std::size_t page = 1000;
    Json proven = Json::array();
    for (Seq from = 0; from < size;) {
        WEAVE_TRY(const Json part, audit.events(caller, from, page, design));
        const Json& events = part.at("events");
        for (const Json& event : events) {
            const auto seq = event.at("seq").get<Seq>();
            if (seq >= size) return proven;
            WEAVE_TRY(const Json proof, audit.inclusion(caller, seq, size));
            Json entry = event;
            entry["path"] = proof.at("path");
            proven.push_back(std::move(entry));
        }
        if (events.size() < page) break;
        from = events.back().at("seq").get<Seq>() + 1;
    }
    return proven;
}

/// Everything about a revision in one document: the answer about it, its design file, the signed head of the
/// log, and the records about its design with proofs.
Result<Json> revision_bundle(const ApiCall& call, DesignDesk& designs, AuditDesk& audit) {
    const Caller& caller = call.visitor.caller();
    const std::string& design = call.place("design");
    const std::int64_t number = call.number();
    WEAVE_TRY(Json revision, designs.revision(caller, design, number));
    WEAVE_TRY(std::string document, designs.document(caller, design, number));
    WEAVE_TRY(Json head, audit.head(caller));
    WEAVE_TRY(Json events, proven_events(audit, caller, design, head.at("size").get<std::uint64_t>()));
    return Json{{"format", "loomlink-revision-bundle"},
                {"version", 1},
                {"revision", std::move(revision)},
                {"document", std::move(document)},
                {"head", std::move(head)},
                {"events", std::move(events)}};
}

}  // namespace

void add_bundle_handler(ApiHandlers& handlers, DesignDesk& designs, AuditDesk& audit) {
    handlers.answers["revision.bundle"] = giving([&designs, &audit](const ApiCall& call) -> Result<Content> {
        WEAVE_TRY(const Json bundle, revision_bundle(call, designs, audit));
        return Content{"application/json", bundle.dump(-1, ' ', false, Json::error_handler_t::replace),
                       call.place("design") + "-" + call.place("n") + "-bundle.json"};
    });
}

void add_audit_handlers(ApiHandlers& handlers, AuditDesk& audit) {
    auto& answers = handlers.answers;
    answers["events"] = answering([&audit](const ApiCall& call) {
        return audit.events(call.visitor.caller(), call.query.value("from", Seq{0}),
                            call.query.value("limit", usual_limit), design_of(call));
    });
    answers["audit.head"] =
        answering([&audit](const ApiCall& call) { return audit.head(call.visitor.caller()); });
    answers["audit.inclusion"] = answering([&audit](const ApiCall& call) -> Result<Json> {
        WEAVE_TRY(const std::uint64_t size, size_of(call, audit));
        return audit.inclusion(call.visitor.caller(), call.query.value("seq", Seq{0}), size);
    });
    answers["audit.consistency"] = answering([&audit](const ApiCall& call) -> Result<Json> {
        WEAVE_TRY(const std::uint64_t size, size_of(call, audit));
        return audit.consistency(call.visitor.caller(), call.query.value("from", std::uint64_t{0}), size);
    });
    answers["audit.bundle"] = giving([&audit](const ApiCall& call) -> Result<Content> {
        WEAVE_TRY(std::string bytes, audit.bundle(call.visitor.caller()));
        return Content{"application/octet-stream", std::move(bytes), "audit-bundle.json"};
    });
}

}  // namespace weave::loomlink
