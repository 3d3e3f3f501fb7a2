// What the log says of attempts that were refused, and how much of it one person can make it say.

#include "flow_case.hpp"
#include "service_case.hpp"

#include <loomlink/workflow/names.hpp>

namespace weave::loomlink::testing {

namespace {

/// A site where dora's first revision waits for approval, and the loom EP 1 is otto's.
struct BusyMill : FlowSite {
    BusyMill() {
        set_policy();
        set_up_loom();
        got(flow->looms().add(people.at("ada"), ask(), "EP 2", profile("ep-2688")));
        got(flow->designs().add(people.at("dora"), ask(), "shoe"));
        save("dora", {});
    }

    /// The record that this attempt leaves behind; nothing else changes.
    template <class Work>
    Statement record_of(const Work& work) {
        const std::string before = dump();
        const Seq size = log_size();
        const auto outcome = work();
        if (outcome) FAIL("was done");
        INFO(outcome.error().text());
        CHECK(dump() == before);
        const auto said = statements(size);
        REQUIRE(said.size() == 1);
        CHECK(said[0].kind == "refused");
        Statement told = said[0];
        told.data = sorted(told.data);
        return told;
    }
};

}  // namespace

TEST_CASE("what cannot be understood is logged with what was attempted and where, not with what was typed") {
    BusyMill mill;
    Workflow& flow = *mill.flow;
    const Caller& dora = mill.people.at("dora");
    const Caller& abe = mill.people.at("abe");

    const std::string no_design = "{\"format\":1,\"secret\":\"pass phrase\"}";
    Statement said = mill.record_of([&] {
        return flow.designs().save(dora, mill.ask(), {"shoe", "main", "my pass phrase", no_design, 1, {}});
    });
    CHECK(said.actor == "dora");
    CHECK(said.subject == "shoe");
    CHECK(said.data == sorted(Json{{"what", "revision.saved"},
                                   {"branch", "main"},
                                   {"expected", 1},
                                   {"document_sha256", hash_hex(sha256(no_design))}}));
    CHECK(statement_bytes(said).find("pass phrase") == std::string::npos);

    said = mill.record_of([&] { return flow.designs().add(dora, mill.ask(), std::string(3000, 'x')); });
    CHECK(said.data == sorted(Json{{"what", "design.added"}}));
    CHECK(said.subject->size() < 200);
    CHECK_THAT(*said.reason, Catch::StartsWith("name: must be 1 to 64 of the letters a to z"));

    const std::string long_reason = std::string(4001, 'y');
    said = mill.record_of([&] {
        return flow.steps().submit(dora, mill.ask("dora"), {"shoe", 1, long_reason}, {"EP 1"});
    });
    CHECK(said.data == sorted(Json{{"what", "revision.submitted"}, {"revision", 1}, {"looms", {"EP 1"}}}));
    CHECK(*said.reason == "reason: is longer than 4000 bytes");

    got(flow.steps().submit(dora, mill.ask("dora"), {"shoe", 1, "ready"}, {}));
    said = mill.record_of([&] {
        return flow.steps().waive(abe, mill.ask("abe"), {"shoe", 1, "seen"}, "float.no-such-rule", "EP 1");
    });
    CHECK(
        said.data ==
        sorted(Json{
            {"what", "revision.waived"}, {"revision", 1}, {"rule", "float.no-such-rule"}, {"loom", "EP 1"}}));
    said = mill.record_of([&] {
        return flow.looms().add(mill.people.at("ada"), mill.ask(), "EP 3", "{\"format\":\"unknown\"}");
    });
    CHECK(said.subject == "EP 3");
    CHECK(said.data == sorted(Json{{"what", "loom.added"}}));
    said = mill.record_of([&] {
        return flow.accounts().invite(mill.people.at("ada"), mill.ask(), {"designer", "king"});
    });
    CHECK(said.data == sorted(Json{{"what", "person.invited"}, {"roles", {"designer", "king"}}}));
    said = mill.record_of([&] {
        Ask odd = mill.ask();
        odd.request = "no id";
        return flow.designs().add(dora, odd, "boot");
    });
    CHECK(said.subject == "boot");
    CHECK(said.request != "no id");
}

TEST_CASE("refusals name the revision, the loom, the release and the file, and no password") {
    BusyMill mill;
    Workflow& flow = *mill.flow;
    const Caller& dora = mill.people.at("dora");
    const Caller& abe = mill.people.at("abe");
    const Caller& otto = mill.people.at("otto");
    CHECK(mill.record_of([&] {
                  return flow.releases().release(abe, mill.ask("abe"), {"shoe", 1, "EP 1", {1}, 7, "go"});
              })
              .data ==
          sorted(Json{{"what", "release.made"}, {"revision", 1}, {"loom", "EP 1"}, {"supersedes", 7}}));
    mill.approve(1);
    got(flow.releases().release(abe, mill.ask("abe"), {"shoe", 1, "EP 1", {1}, {}, "go"}));
    const Json release{{"loom", "EP 1"}, {"release", 1}};
    const auto with = [&](Json more) {
        more.update(release);
        return sorted(more);
    };
    CHECK(mill.record_of([&] { return flow.releases().sign(abe, mill.ask("abe"), "EP 1", 1, "go"); }).data ==
          with({{"what", "release.signed"}}));
    CHECK(mill.record_of([&] { return flow.releases().file(otto, "EP 1", 1, "none\nat all"); }).data ==
          with({{"what", "release.pulled"}, {"file", "none\\x0aat all"}}));
    Statement said = mill.record_of([&] {
        Ask wrong = mill.ask();
        wrong.password = "a wrong pass phrase";
        return flow.releases().withdraw(abe, wrong, "EP 1", 1, "the pass phrase is typed here");
    });
    CHECK(said.data == with({{"what", "release.withdrawn"}}));
    CHECK(statement_bytes(said).find("pass phrase") == std::string::npos);

    const std::string none = "EP 2";
    CHECK(mill.record_of([&] { return flow.releases().index(otto, none, 1, 0); }).data ==
          sorted(Json{{"what", "loom.index_pulled"}}));
    CHECK(mill.record_of([&] { return flow.looms().read(otto, none); }).subject == "EP 2");
    CHECK(mill.record_of([&] { return flow.releases().read(otto, none, 1); }).data ==
          sorted(Json{{"what", "release.viewed"}, {"loom", "EP 2"}, {"release", 1}}));
    CHECK(mill.record_of([&] { return flow.designs().revision(otto, "shoe", 1); }).data ==
          sorted(Json{{"what", "revision.viewed"}, {"revision", 1}}));
    CHECK(mill.record_of([&] { return flow.designs().document(dora, "shoe", 9); }).data.at("revision") == 9);
}

TEST_CASE("the same refusal is logged once in a while, and one person fills no log") {
    BusyMill mill;
    Workflow& flow = *mill.flow;
    const Caller& otto = mill.people.at("otto");
    const auto ask_for = [&](const std::string& loom) {
        CHECK_FALSE(flow.releases().index(otto, loom, 1, 0));
    };
    Seq size = mill.log_size();
    for (int k = 0; k < 20; ++k) ask_for("EP 2");
    CHECK(mill.statements(size).size() == 1);
    mill.time += std::chrono::minutes(11);
    ask_for("EP 2");
    REQUIRE(mill.statements(size).size() == 2);
    CHECK(mill.statements(size).back().data.at("left_out") == 19);

    size = mill.log_size();
    for (int k = 0; k < 300; ++k) ask_for("loom " + std::to_string(k));
    const std::size_t written = mill.statements(size).size();
    CHECK(written >= 90);
    CHECK(written <= 100);
    const Seq full = mill.log_size();
    CHECK_FALSE(flow.designs().add(mill.people.at("dora"), mill.ask(), "no/name"));
    CHECK(mill.statements(full).size() == 1);  // what one does takes no record from another
    mill.time += std::chrono::minutes(1);
    ask_for("yet another");
    CHECK(mill.statements(full).back().data.at("left_out") == 300 - written);

    size = mill.log_size();
    for (int k = 0; k < 3; ++k) {
        Ask wrong = mill.ask();
        wrong.password = "a wrong one";
        CHECK_FALSE(flow.steps().submit(mill.people.at("dora"), wrong, {"shoe", 1, "ready"}, {}));
    }
    CHECK(mill.statements(size).size() == 3);  // each try of a password counts
}

TEST_CASE("a design, a loom or a branch has a name that every system tells from all others") {
    BusyMill mill;
    Workflow& flow = *mill.flow;
    const auto design = [&](const std::string& name) {
        return flow.designs().add(mill.people.at("dora"), mill.ask(), name);
    };
    const auto loom = [&](const std::string& name) {
        return flow.looms().add(mill.people.at("ada"), mill.ask(), name, FlowSite::profile("ep-2688"));
    };
    const std::vector<std::pair<std::string, std::string>> bad{{"", "letters a to z"},
                                                               {"sh\xc3\xb6"
                                                                "e",
                                                                "letters a to z"},
                                                               {"a/b", "letters a to z"},
                                                               {std::string(65, 'a'), "1 to 64"},
                                                               {".", "start with '.'"},
                                                               {"..", "start with '.'"},
                                                               {".shoe", "start with '.'"},
                                                               {"-rf", "start with '.' or '-'"},
                                                               {"shoe.", "end with '.'"},
                                                               {"con", "device on Windows"},
                                                               {"NUL", "device on Windows"},
                                                               {"Com1.weave", "device on Windows"},
                                                               {"lpt9", "device on Windows"},
                                                               {" shoe", "letters a to z"}};
    for (const auto& [name, words] : bad) {
        INFO(name);
        for (const auto& outcome : {design(name), loom(name)}) {
            REQUIRE_FALSE(outcome);
            CHECK(outcome.error().code == ErrorCode::bad_input);
            CHECK_THAT(outcome.error().text(), Catch::Contains(words));
        }
    }
    for (const char* name : {"EP  1", "con .x", "EP 1 "}) CHECK_FALSE(loom(name));
    for (const char* name : {"Shoe", "SHOE", "shoe"}) {
        const auto outcome = design(name);
        CHECK(denied(outcome) == Denial::conflict);
        CHECK(outcome.error().message == "the name is taken: there is a design 'shoe'");
    }
    CHECK(denied(loom("ep 1")) == Denial::conflict);
    CHECK(denied(flow.designs().save(mill.people.at("dora"), mill.ask(),
                                     {"shoe", "MAIN", "again", FlowSite::document("other"), {}, {1}})) ==
          Denial::conflict);
    for (const char* name : {"console", "com10", "a.b_c-D9", "shoe2"}) got(design(name));
    got(loom("com 1"));
}

TEST_CASE("names of people are on one line and hide nothing; texts do not turn what is around them") {
    const auto line = [](const std::string& text) { return bool(check_line(text, "full_name", 1, 128)); };
    const auto words = [](const std::string& text) { return bool(check_text(text, "reason")); };
    for (const char* name : {"Mary Miller", "Zo\u00eb \u00d8rsted", "\u738b\u5c0f\u660e", "O'Neill-Smith"}) {
        CHECK(line(name));
        CHECK(words(name));
    }
    for (const char* mark : {"\u202a", "\u202e", "\u2066", "\u2069", "\u200e", "\u200f", "\u061c", "\u0085",
                             "\u009b", "\u2028", "\x07", "\x7f", "\xff"}) {
        INFO(Catch::StringMaker<std::string>::convert(mark));
        CHECK_FALSE(line(std::string("Mary") + mark + "Miller"));
        CHECK_FALSE(words(std::string("Mary") + mark + "Miller"));
    }
    for (const char* mark : {"\n", "\t", "\u200b", "\u200c", "\u200d", "\u2060", "\ufeff", "\u00ad", "\u3164",
                             "\ufe0f", "\U000e0041"}) {
        INFO(Catch::StringMaker<std::string>::convert(mark));
        CHECK_FALSE(line(std::string("Mary") + mark + "Miller"));
        CHECK(words(std::string("Mary") + mark + "Miller"));
    }
    CHECK_FALSE(line("   "));
    CHECK_FALSE(line(""));
    CHECK_FALSE(line(std::string(129, 'a')));

    FlowSite site;
    const Json code = got(site.flow->accounts().invite(site.people.at("ada"), site.ask(), {"designer"}));
    const auto join = [&](const std::string& full_name) {
        return site.flow->accounts().join(code.at("code"), "mary", full_name, "warp and weft and warp", "");
    };
    CHECK_FALSE(join("Mary\u202emilleR"));
    CHECK_FALSE(join("Mary\nMiller"));
    got(join("Mary Miller"));
}

TEST_CASE("what has nothing in it that one can see is no reason at any step") {
    const std::string nothing[]{"", " ", " \t\n ", "\u00a0\u3000", "\u200b", " \u2060\ufeff ", "\u2800", "\ufe0f\U000e0041"};
    for (const char* text : {".", "\u738b", " \u200bx", "\U0001f9f5", "\u0301"}) CHECK(check_text(text, "reason"));

    BusyMill mill;
    Workflow& flow = *mill.flow;
    const Caller& dora = mill.people.at("dora");
    const Caller& abe = mill.people.at("abe");
    const auto asks_for = [&](const std::string& member, const auto& step) {
        for (const std::string& text : nothing) {
            const std::string before = mill.dump();
            const Result<Json> outcome = step(text);
            INFO(member << ' ' << Catch::StringMaker<std::string>::convert(text));
            REQUIRE_FALSE(outcome);
            CHECK(outcome.error().text() == member + ": says nothing: there is no character in it that one can see");
            CHECK(mill.dump() == before);
        }
    };
    asks_for("message", [&](const std::string& text) {
        return flow.designs().save(dora, mill.ask(), {"shoe", "main", text, FlowSite::document("other"), 1, {}});
    });
    asks_for("reason", [&](const std::string& text) { return flow.steps().submit(dora, mill.ask("dora"), {"shoe", 1, text}, {}); });
    got(flow.steps().submit(dora, mill.ask("dora"), {"shoe", 1, "ready"}, {}));
    const auto asks_abe = [&](const auto& step) {
        asks_for("reason", [&](const std::string& text) { return step(StepWish{"shoe", 1, text}); });
    };
    asks_abe([&](const StepWish& wish) { return flow.steps().request_changes(abe, mill.ask("abe"), wish); });
    asks_abe([&](const StepWish& wish) { return flow.steps().waive(abe, mill.ask("abe"), wish, "float.face", "EP 1"); });
    asks_abe([&](const StepWish& wish) { return flow.steps().approve(abe, mill.ask("abe"), wish); });
    asks_for("text", [&](const std::string& text) { return flow.steps().comment(abe, mill.ask(), {"shoe", 1, text}, {}, {}); });
    got(flow.steps().approve(abe, mill.ask("abe"), {"shoe", 1, "good"}));
    asks_for("reason", [&](const std::string& text) {
        return flow.releases().release(abe, mill.ask("abe"), {"shoe", 1, "EP 1", {1}, {}, text});
    });
    got(flow.releases().release(abe, mill.ask("abe"), {"shoe", 1, "EP 1", {1}, {}, "go"}));
    asks_for("text", [&](const std::string& text) {
        return flow.looms().report_fault(mill.people.at("otto"), mill.ask(), "EP 1", 1, text, {}, {});
    });
    asks_for("reason", [&](const std::string& text) { return flow.releases().sign(abe, mill.ask("abe"), "EP 1", 1, text); });
    asks_for("reason", [&](const std::string& text) { return flow.releases().withdraw(abe, mill.ask("abe"), "EP 1", 1, text); });
}

TEST_CASE("a document that the branch holds already makes no revision, unless it joins branches") {
    BusyMill mill;
    Workflow& flow = *mill.flow;
    SaveWish same{"shoe", "main", "again", FlowSite::document(), 1, {}};
    const auto save = [&] { return flow.designs().save(mill.people.at("dora"), mill.ask(), same); };
    const Statement said = mill.record_of(save);
    CHECK(*said.reason == "this is what revision 1 holds already: nothing to save");
    same.also = {1};  // names the head itself: no other parent
    CHECK(denied(save()) == Denial::conflict);
    same.also.clear();
    same.branch = "trial";
    same.expected.reset();
    same.also = {1};
    CHECK(got(save()).at("number") == 2);
    same = {"shoe", "main", "joined", FlowSite::document(), 1, {2}};
    CHECK(got(save()).at("number") == 3);
    same = {"shoe", "main", "other", FlowSite::document("other"), 3, {}};
    CHECK(got(save()).at("number") == 4);
}

TEST_CASE("who comes at the wrong time is told what can be done instead") {
    BusyMill mill;
    Steps& steps = mill.flow->steps();
    const auto told = [](const Result<Json>& outcome) {
        CHECK(denied(outcome) == Denial::conflict);
        return outcome.error().message;
    };
    const auto submit = [&](std::int64_t number) {
        return steps.submit(mill.people.at("dora"), mill.ask("dora"), {"shoe", number, "ready"}, {});
    };
    const auto approve = [&] {
        return steps.approve(mill.people.at("abe"), mill.ask("abe"), {"shoe", 1, "good"});
    };
    CHECK(told(approve()) == "revision 1 was not submitted yet: a designer submits it first");
    got(submit(1));
    CHECK(told(submit(1)) == "revision 1 waits for approval already");
    CHECK(told(mill.flow->releases().release(mill.people.at("abe"), mill.ask("abe"),
                                             {"shoe", 1, "EP 1", {1}, {}, "go"})) ==
          "revision 1 waits for approval still: it has to be approved first");
    got(approve());
    CHECK(told(approve()) == "revision 1 is approved already: it can be released");
    const auto outcome = steps.request_changes(mill.people.at("dora"), mill.ask("dora"), {"shoe", 1, "no"});
    CHECK(denied(outcome) == Denial::rights);
    CHECK(outcome.error().message == "your roles do not let you request changes");
}

TEST_CASE("a refusal says what it is about and what there is") {
    BusyMill mill;
    Workflow& flow = *mill.flow;
    const Caller& dora = mill.people.at("dora");
    const Caller& abe = mill.people.at("abe");
    const auto told = [](const Result<Json>& outcome) {
        if (outcome) FAIL("was done");
        return outcome.error().text();
    };
    const auto save = [&](const std::string& document, std::int64_t expected) {
        return told(flow.designs().save(dora, mill.ask(), {"shoe", "main", "next", document, expected, {}}));
    };
    CHECK_THAT(save("\x89PNG\r\n", 1), Catch::StartsWith("is no design, which would begin with {"));
    CHECK(save("weave-yarns 1\n", 1) == "holds relaxed yarns, no design");
    CHECK_THAT(save(FlowSite::document("new"), 9), Catch::EndsWith("the design has no revision 9"));
    const auto add_loom = [&](const std::string& profile) {
        return told(flow.looms().add(mill.people.at("ada"), mill.ask(), "EP 3", profile));
    };
    CHECK_THAT(add_loom(FlowSite::document()), Catch::EndsWith("is a design, no profile of a loom"));
    CHECK_THAT(add_loom("\x89PNG\r\n"), Catch::EndsWith("is no profile of a loom, which would begin with {"));
    const auto comment = [&](std::optional<std::int64_t> pick, std::optional<std::int64_t> end) {
        return told(flow.steps().comment(abe, mill.ask(), {"shoe", 1, "here"}, pick, end));
    };
    CHECK(comment(5, 1) == "pick: the card has picks 1 to 4");
    CHECK(comment(4, 9) == "end: the card has ends 1 to 8");
    mill.approve(1);
    const auto release = [&](std::int64_t feeder) {
        return flow.releases().release(abe, mill.ask("abe"), {"shoe", 1, "EP 1", {feeder}, {}, "go"});
    };
    CHECK(told(release(99)) == "feeders: this loom has no feeder 99, it has 1 to 6");
    CHECK(told(release(0)) == "feeders: this loom has no feeder 0, it has 1 to 6");
    got(release(1));
    CHECK(told(flow.looms().report_fault(mill.people.at("otto"), mill.ask(), "EP 1", 1, "a float", 9999, {})) ==
          "pick: the card has picks 1 to 4");
}

}  // namespace weave::loomlink::testing
