#include <loomlink/service/answering.hpp>
#include <loomlink/service/handlers.hpp>

namespace weave::loomlink {

namespace {

void add_files(ApiHandlers& handlers, ReleaseDesk& releases) {
    auto& answers = handlers.answers;
    answers["release.manifest"] = giving([&releases](const ApiCall& call) -> Result<Content> {
        const std::int64_t number = call.number();
        WEAVE_TRY(std::string bytes, releases.manifest(call.visitor.caller(), call.place("loom"), number));
        return Content{"application/octet-stream", std::move(bytes), "manifest.json"};
    });
    answers["release.file"] = giving([&releases](const ApiCall& call) -> Result<Content> {
        const std::int64_t number = call.number();
        const std::string& name = call.place("name");
        WEAVE_TRY(std::string bytes, releases.file(call.visitor.caller(), call.place("loom"), number, name));
        return Content{"application/octet-stream", std::move(bytes), name};
    });
    answers["release.card"] = giving([&releases](const ApiCall& call) -> Result<Content> {
        const std::int64_t number = call.number();
        WEAVE_TRY(std::string png,
                  releases.card(call.visitor.caller(), call.place("loom"), number, tile_of(call)));
        return Content{"image/png", std::move(png)};
    });
    answers["release.picks"] = answering([&releases](const ApiCall& call) -> Result<Json> {
        const std::int64_t number = call.number();
        return releases.picks(call.visitor.caller(), call.place("loom"), number, call.query.value("from", 1),
                              call.query.value("count", 1));
    });
}

/// Steps after which a loom's index is another one.
void add_release_steps(ApiHandlers& handlers, ReleaseDesk& releases, const Watchers& watchers) {
    auto& answers = handlers.answers;
    answers["release.make"] = answering([&releases, watchers](const ApiCall& call) -> Result<Json> {
        const ReleaseWish wish{
            call.text("design"),      call.whole("revision").value_or(0),
            call.text("loom"),        call.body.value("feeders", std::vector<std::int64_t>()),
            call.whole("supersedes"), call.text("reason")};
        WEAVE_TRY(Json answer, releases.release(call.visitor.caller(), ask_of(call), wish));
        watchers.tell(wish.loom);
        return answer;
    });
    for (const bool sign : {true, false})
        answers[sign ? "release.sign" : "release.withdraw"] =
            answering([&releases, watchers, sign](const ApiCall& call) -> Result<Json> {
                const std::int64_t number = call.number();
                const std::string& loom = call.place("loom");
                const Caller& caller = call.visitor.caller();
                const std::string why = call.text("reason");
                WEAVE_TRY(Json answer, sign ? releases.sign(caller, ask_of(call), loom, number, why)
                                            : releases.withdraw(caller, ask_of(call), loom, number, why));
                watchers.tell(loom);
                return answer;
            });
}

}  // namespace

void add_release_handlers(ApiHandlers& handlers, ReleaseDesk& releases, const Watchers& watchers) {
    auto& answers = handlers.answers;
    answers["release"] = answering([&releases](const ApiCall& call) -> Result<Json> {
        const std::int64_t number = call.number();
        return releases.read(call.visitor.caller(), call.place("loom"), number);
    });
    answers["loom.index"] = answering([&releases](const ApiCall& call) {
        return releases.index(call.visitor.caller(), call.place("loom"),
                              call.query.value("trust", std::int64_t{0}) + 1,
                              call.query.value("head", std::uint64_t{0}));
    });
    add_files(handlers, releases);
    add_release_steps(handlers, releases, watchers);
}

void add_trust_handlers(ApiHandlers& handlers, TrustChain& trust, const Watchers& watchers) {
    auto& answers = handlers.answers;
    answers["trust"] = answering(
        [&trust](const ApiCall& call) { return trust.documents(call.query.value("from", std::int64_t{1})); });
    answers["trust.pending"] =
        answering([&trust](const ApiCall& call) { return trust.pending(call.visitor.caller()); });
    answers["trust.extend"] = answering([&trust, watchers](const ApiCall& call) -> Result<Json> {
        const bool keep = call.body.value("keep_server_keys", false);
        WEAVE_TRY(Json answer, trust.publish(call.visitor.caller(), ask_of(call), keep));
        watchers.tell_all();
        return answer;
    });
}

}  // namespace weave::loomlink
