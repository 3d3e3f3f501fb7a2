#include <loomlink/service/answering.hpp>
#include <loomlink/service/handlers.hpp>

namespace weave::loomlink {

namespace {

std::string name_of(const ApiCall& call) {
    return call.place("design") + "-" + call.place("n");
}

void add_views(ApiHandlers& handlers, DesignDesk& designs) {
    auto& answers = handlers.answers;
    answers["revision"] = answering([&designs](const ApiCall& call) -> Result<Json> {
        const std::int64_t number = call.number();
        return designs.revision(call.visitor.caller(), call.place("design"), number);
    });
    answers["revision.check"] = answering([&designs](const ApiCall& call) -> Result<Json> {
        const std::int64_t number = call.number();
        return designs.check(call.visitor.caller(), call.place("design"), number,
                             call.query.value("loom", std::string()));
    });
    answers["revision.document"] = giving([&designs](const ApiCall& call) -> Result<Content> {
        const std::int64_t number = call.number();
        WEAVE_TRY(std::string text, designs.document(call.visitor.caller(), call.place("design"), number));
        return Content{"application/octet-stream", std::move(text), name_of(call) + ".weave"};
    });
    answers["revision.picture"] = giving([&designs](const ApiCall& call) -> Result<Content> {
        const std::int64_t number = call.number();
        WEAVE_TRY(std::string png, designs.picture(call.visitor.caller(), call.place("design"), number,
                                                   call.query.value("view", std::string())));
        return Content{"image/png", std::move(png)};
    });
    answers["revision.card"] = giving([&designs](const ApiCall& call) -> Result<Content> {
        const std::int64_t number = call.number();
        WEAVE_TRY(std::string png,
                  designs.card(call.visitor.caller(), call.place("design"), number, tile_of(call)));
        return Content{"image/png", std::move(png)};
    });
}

void add_differences(ApiHandlers& handlers, DesignDesk& designs) {
    handlers.answers["diff"] = answering([&designs](const ApiCall& call) {
        return designs.diff(call.visitor.caller(), call.place("design"), call.query.value("from", 0),
                            call.query.value("to", 0));
    });
    handlers.answers["diff.picture"] = giving([&designs](const ApiCall& call) -> Result<Content> {
        WEAVE_TRY(std::string png,
                  designs.diff_picture(call.visitor.caller(), call.place("design"),
                                       call.query.value("from", 0), call.query.value("to", 0)));
        return Content{"image/png", std::move(png)};
    });
}

}  // namespace

void add_design_handlers(ApiHandlers& handlers, DesignDesk& designs) {
    auto& answers = handlers.answers;
    answers["designs"] =
        answering([&designs](const ApiCall& call) { return designs.list(call.visitor.caller()); });
    answers["design"] = answering([&designs](const ApiCall& call) {
        return designs.graph(call.visitor.caller(), call.place("design"));
    });
    answers["design.make"] = answering([&designs](const ApiCall& call) {
        return designs.add(call.visitor.caller(), ask_of(call), call.text("name"));
    });
    answers["revision.save"] = answering([&designs](const ApiCall& call) {
        return designs.save(
            call.visitor.caller(), ask_of(call),
            {call.place("design"), call.text("branch"), call.text("message"), call.text("document"),
             call.whole("expected"), call.body.value("also", std::vector<std::int64_t>())});
    });
    add_views(handlers, designs);
    add_differences(handlers, designs);
}

}  // namespace weave::loomlink
