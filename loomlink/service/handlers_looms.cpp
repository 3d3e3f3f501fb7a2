#include <loomlink/service/answering.hpp>
#include <loomlink/service/handlers.hpp>

namespace weave::loomlink {

namespace {

/// The text of a profile, which came as JSON or as the text of it.
std::string profile_of(const ApiCall& call) {
    const Json& profile = call.body.at("profile");
    return profile.is_string() ? profile.get<std::string>() : profile.dump();
}

std::int64_t release_of(const ApiCall& call) {
    return call.whole("release").value_or(0);
}

/// What operators tell of their loom.
void add_words_from_the_loom(ApiHandlers& handlers, LoomDesk& looms) {
    auto& answers = handlers.answers;
    answers["loom.place"] = answering([&looms](const ApiCall& call) {
        return looms.keep_place(call.visitor.caller(), ask_of(call), call.place("loom"), release_of(call),
                                call.whole("pick").value_or(0));
    });
    answers["loom.loaded"] = answering([&looms](const ApiCall& call) {
        return looms.confirm_loaded(call.visitor.caller(), ask_of(call), call.place("loom"),
                                    release_of(call));
    });
    answers["loom.fault"] = answering([&looms](const ApiCall& call) {
        return looms.report_fault(call.visitor.caller(), ask_of(call), call.place("loom"), release_of(call),
                                  call.text("text"), call.whole("pick"), call.whole("end"));
    });
    answers["loom.faults"] = answering([&looms](const ApiCall& call) -> Result<Json> {
        WEAVE_TRY(const Json loom, looms.read(call.visitor.caller(), call.place("loom")));
        return Json{{"faults", loom.at("faults")}};
    });
}

}  // namespace

void add_loom_handlers(ApiHandlers& handlers, LoomDesk& looms, const Watchers& watchers) {
    auto& answers = handlers.answers;
    answers["looms"] = answering([&looms](const ApiCall& call) { return looms.list(call.visitor.caller()); });
    answers["loom"] = answering(
        [&looms](const ApiCall& call) { return looms.read(call.visitor.caller(), call.place("loom")); });
    answers["loom.make"] = answering([&looms](const ApiCall& call) {
        return looms.add(call.visitor.caller(), ask_of(call), call.text("name"), profile_of(call));
    });
    answers["loom.profile"] = answering([&looms, watchers](const ApiCall& call) -> Result<Json> {
        const std::string& loom = call.place("loom");
        WEAVE_TRY(Json answer,
                  looms.set_profile(call.visitor.caller(), ask_of(call), loom, profile_of(call)));
        watchers.tell(loom);
        return answer;
    });
    answers["loom.operators"] = answering([&looms](const ApiCall& call) {
        return looms.set_operators(call.visitor.caller(), ask_of(call), call.place("loom"),
                                   call.body.value("operators", std::vector<std::string>()));
    });
    add_words_from_the_loom(handlers, looms);
}

}  // namespace weave::loomlink
