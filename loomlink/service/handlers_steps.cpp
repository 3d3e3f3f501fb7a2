#include <loomlink/service/answering.hpp>
#include <loomlink/service/handlers.hpp>

namespace weave::loomlink {

namespace {

Result<StepWish> wish_of(const ApiCall& call, const std::string& reason) {
    const std::int64_t number = call.number();
    return StepWish{call.place("design"), number, call.text(reason)};
}

/// A document that came as JSON or as the text of it.
Result<Json> document_of(const ApiCall& call, const std::string& field) {
    const Json& given = call.body.at(field);
    if (!given.is_string()) return given;
    auto read = parse_json(given.get_ref<const std::string&>());
    if (!read) return std::move(read).error().under(field);
    return read;
}

Result<Signature> signature_of(const ApiCall& call) {
    WEAVE_TRY(const Json json, document_of(call, "signature"));
    const auto is_text = [&](const char* name) { return json.contains(name) && json[name].is_string(); };
    if (!json.is_object() || json.size() != 2 || !is_text("key") || !is_text("value"))
        return bad_input("must have key and value, two texts", "signature");
    return Signature{json["key"].get<std::string>(), json["value"].get<std::string>()};
}

}  // namespace

void add_step_handlers(ApiHandlers& handlers, Steps& steps) {
    auto& answers = handlers.answers;
    answers["revision.submit"] = answering([&steps](const ApiCall& call) -> Result<Json> {
        WEAVE_TRY(const StepWish wish, wish_of(call, "reason"));
        return steps.submit(call.visitor.caller(), ask_of(call), wish,
                            call.body.value("looms", std::vector<std::string>()));
    });
    answers["revision.comment"] = answering([&steps](const ApiCall& call) -> Result<Json> {
        WEAVE_TRY(const StepWish wish, wish_of(call, "text"));
        return steps.comment(call.visitor.caller(), ask_of(call), wish, call.whole("pick"),
                             call.whole("end"));
    });
    answers["revision.request-changes"] = answering([&steps](const ApiCall& call) -> Result<Json> {
        WEAVE_TRY(const StepWish wish, wish_of(call, "reason"));
        return steps.request_changes(call.visitor.caller(), ask_of(call), wish);
    });
    answers["revision.waive"] = answering([&steps](const ApiCall& call) -> Result<Json> {
        WEAVE_TRY(const StepWish wish, wish_of(call, "reason"));
        return steps.waive(call.visitor.caller(), ask_of(call), wish, call.text("rule"), call.text("loom"));
    });
    answers["revision.approve"] = answering([&steps](const ApiCall& call) -> Result<Json> {
        WEAVE_TRY(const StepWish wish, wish_of(call, "reason"));
        return steps.approve(call.visitor.caller(), ask_of(call), wish);
    });
}

void add_evidence_handlers(ApiHandlers& handlers, EvidenceDesk& evidence) {
    auto& answers = handlers.answers;
    answers["revision.evidence"] = answering([&evidence](const ApiCall& call) -> Result<Json> {
        const std::int64_t number = call.number();
        WEAVE_TRY(const Json statement, document_of(call, "statement"));
        WEAVE_TRY(const Signature signature, signature_of(call));
        return evidence.add(call.place("design"), number, call.id(), statement, signature,
                            call.text("report"));
    });
    answers["signers"] =
        answering([&evidence](const ApiCall& call) { return evidence.signers(call.visitor.caller()); });
    answers["signer.invite"] = answering([&evidence](const ApiCall& call) {
        return evidence.invite_signer(call.visitor.caller(), ask_of(call), call.text("name"));
    });
    answers["signer.enrol"] = answering([&evidence](const ApiCall& call) {
        return evidence.enrol(call.text("code"), call.text("public"), call.visitor.address);
    });
    answers["signer.revoke"] = answering([&evidence](const ApiCall& call) {
        return evidence.revoke_signer(call.visitor.caller(), ask_of(call), call.place("name"));
    });
}

}  // namespace weave::loomlink
