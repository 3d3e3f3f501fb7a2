// Rows changed by SQL behind the back of the workflow, the triggers put back as if nothing had been: the log
// stays whole, and what it tells finds every one of them.

#include "flow_case.hpp"

#include <weave/keys/hex.hpp>

namespace weave::loomlink::testing {

namespace {

/// Evidence of a machine for revision 1.
void add_evidence(FlowSite& site) {
    Workflow& flow = *site.flow;
    const KeyPair machine = KeyPair::generate();
    const Json code = got(flow.evidence().invite_signer(site.people.at("ada"), site.ask(), "gpu-1"));
    got(flow.evidence().enrol(code.at("code"), to_hex(machine.public_key()), "10.0.0.3"));
    wire::SimulationStatement found = site.simulation_of(1);
    found.regions = {{0, 2, 0, 8}};
    const Json body = statement_body(found);
    got(flow.evidence().add("shoe", 1, "evidence-1", body,
                            machine.sign(Purpose::evidence, canonical_json(body)), "report"));
}

/// Everything that a table can keep, at least once.
void live_a_day(FlowSite& site) {
    Workflow& flow = *site.flow;
    const auto& people = site.people;
    site.set_policy();
    site.set_up_loom();
    got(flow.designs().add(people.at("dora"), site.ask(), "shoe"));
    site.save("dora", {});
    add_evidence(site);
    got(flow.steps().submit(people.at("dora"), site.ask("dora"), {"shoe", 1, "ready"}, {}));
    got(flow.steps().comment(people.at("abe"), site.ask(), {"shoe", 1, "a loose end"}, 1, {}));
    got(flow.steps().waive(people.at("abe"), site.ask("abe"), {"shoe", 1, "known"}, "hooks.fit", "EP 1"));
    got(flow.steps().approve(people.at("abe"), site.ask("abe"), {"shoe", 1, "good"}));
    got(flow.releases().release(people.at("abe"), site.ask("abe"), {"shoe", 1, "EP 1", {1}, {}, "go"}));
    got(flow.looms().confirm_loaded(people.at("otto"), site.ask(), "EP 1", 1));
    got(flow.looms().keep_place(people.at("otto"), site.ask(), "EP 1", 1, 3));
    got(flow.looms().report_fault(people.at("otto"), site.ask(), "EP 1", 1, "it tears", 2, {}));
    got(flow.releases().withdraw(people.at("enno"), site.ask("enno"), "EP 1", 1, "wrong yarn"));
    site.save("dora", 1, "twill two");
    got(flow.steps().submit(people.at("dora"), site.ask("dora"), {"shoe", 2, "ready"}, {}));
    got(flow.steps().request_changes(people.at("abe"), site.ask("abe"), {"shoe", 2, "too loose"}));
    got(flow.accounts().access_token(people.at("dora"), site.ask(), 8));
    got(flow.accounts().reset(people.at("ada"), site.ask(), "eve"));
    got(flow.accounts().set_active(people.at("ada"), site.ask(), "enno", false));
    got(flow.accounts().invite(people.at("ada"), site.ask(), {"operator"}));
}

struct Tampering {
    const char* sql;
    const char* words;  ///< of the finding
};

constexpr Tampering tamperings[]{
    {"UPDATE person SET full_name = 'Evil' WHERE login = 'abe'", "person abe: is [\"Evil\""},
    {"UPDATE person SET active = 1 WHERE login = 'enno'", "person enno: is [\"Full enno\",true"},
    {"UPDATE person SET password = (SELECT password FROM person WHERE login = 'dora') WHERE login = 'abe'",
     "person abe: is"},
    {"INSERT INTO person_role SELECT id, 'approver' FROM person WHERE login = 'dora'", "person dora: is"},
    {"DELETE FROM person_role WHERE person = (SELECT id FROM person WHERE login = 'ada')", "person ada: is"},
    {"INSERT INTO person (login, full_name, active, password, event) VALUES ('mallory', 'M', 1, 'x', 1)",
     "person mallory: no record of the log tells of it"},
    {"UPDATE person_key SET revoked = NULL", "but the log tells"},
    {"UPDATE person_key SET public_key = zeroblob(32) WHERE person = (SELECT id FROM person WHERE login = "
     "'abe')",
     ": is [\"abe\",\"release\",\"0000"},
    {"UPDATE person_key SET person = (SELECT id FROM person WHERE login = 'abe') WHERE purpose = 'evidence'",
     ": is [\"abe\",\"evidence\""},
    {"UPDATE person_key SET sealed = NULL WHERE sealed IS NOT NULL", ",null,"},
    {"UPDATE person_key SET sealed = x'00' WHERE sealed IS NOT NULL", ": is [\"abe\",\"release\","},
    {"UPDATE session SET person = (SELECT id FROM person WHERE login = 'ada')", ": is [\"ada\"], but the log"},
    {"INSERT INTO session SELECT randomblob(32), id, '2099-01-01T00:00:00.000Z', 'x' FROM person WHERE login = "
     "'ada'",
     "no record of the log tells of it: [\"ada\"]"},
    {"UPDATE invitation SET roles = 'admin' WHERE used IS NULL AND roles = 'operator'",
     ": is [\"person\",null,\"admin\""},
    {"UPDATE invitation SET used = NULL", "invitation of record"},
    {"DELETE FROM invitation WHERE used IS NULL", "is missing; the log tells [\"person\""},
    {"UPDATE policy SET text = replace(text, '\"approvals\":1', '\"approvals\":2')", "policy 1: is"},
    {"DELETE FROM policy", "policy 1: is missing"},
    {"UPDATE design SET name = 'boot'", "design boot: no record"},
    {"UPDATE design SET event = 0", "design shoe: is [0]"},
    {"UPDATE revision SET message = 'other' WHERE number = 1", "revision 1 of shoe: is"},
    {"UPDATE revision SET picks = 400 WHERE number = 1", "revision 1 of shoe: is"},
    {"DELETE FROM revision_author WHERE revision = 1", "dora, author of revision 1 of shoe: is missing"},
    {"INSERT INTO revision_author SELECT 1, id FROM person WHERE login = 'eve'",
     "eve, author of revision 1 of shoe: no record"},
    {"UPDATE branch SET head = 1", "branch main of shoe: is [1,"},
    {"UPDATE revision_state SET state = 'approved' WHERE state = 'changes_requested'",
     "state of revision 2 of shoe by record"},
    {"INSERT INTO revision_state VALUES (2, (SELECT max(seq) FROM event), 'approved')",
     "no record of the log tells of it: [\"approved\"]"},
    {"INSERT INTO decision (revision, person, kind, event) SELECT 2, id, 'approve', (SELECT max(seq) FROM "
     "event) FROM person WHERE login = 'eve'",
     "no record of the log tells of it: [2,\"shoe\",\"eve\",\"approve\"]"},
    {"UPDATE decision SET kind = 'approve'", "but the log tells [2,\"shoe\",\"abe\",\"request_changes\"]"},
    {"DELETE FROM decision", "decision of record"},
    {"UPDATE waiver SET reason = 'changed'", "waiver of record"},
    {"UPDATE waiver SET rule = 'float.max'", "waiver of record"},
    {"UPDATE evidence SET coverage = 1", "evidence of record"},
    {"UPDATE evidence SET residual = 1e-9", "evidence of record"},
    {"UPDATE evidence SET fidelity = 'reference'", "evidence of record"},
    {"DELETE FROM evidence", "evidence of record"},
    {"UPDATE comment SET text = 'changed'", "comment of record"},
    {"DELETE FROM comment", "comment of record"},
    {"INSERT INTO comment (revision, person, text, event) VALUES (1, 1, 'x', 1)",
     "comment of record 1: no record"},
    {"UPDATE loom SET name = 'EP 9'", "loom EP 9: no record"},
    {"UPDATE loom_profile SET object = (SELECT max(id) FROM object)", "profile 1 of EP 1: is"},
    {"INSERT INTO loom_operator SELECT 1, id, 1 FROM person WHERE login = 'dora'",
     "dora, operator of EP 1: no record"},
    {"DELETE FROM loom_operator", "otto, operator of EP 1: is missing"},
    {"UPDATE release SET feeders = '[2]'", "release 1 of EP 1: is"},
    {"UPDATE release SET revision = 2", "release 1 of EP 1: is [2,"},
    {"UPDATE release_file SET object = (SELECT max(id) FROM object)", "file of release 1 of EP 1: is"},
    {"DELETE FROM release_file WHERE name LIKE '%.ep'", ".ep, file of release 1 of EP 1: is missing"},
    {"UPDATE release_signature SET key = (SELECT id FROM person_key WHERE purpose = 'evidence')",
     "signature of release 1 of EP 1 by record"},
    {"DELETE FROM release_state WHERE state = 'withdrawn'", "is missing; the log tells [\"withdrawn\"]"},
    {"UPDATE release_state SET state = 'superseded' WHERE state = 'withdrawn'",
     ": is [\"superseded\"], but the log tells [\"withdrawn\"]"},
    {"UPDATE bookmark SET pick = 1", "place in release 1 of EP 1: is [1,\"otto\"]"},
    {"UPDATE fault_report SET text = 'nothing'", "fault of record"},
    {"DELETE FROM loaded", "loading of record"},
    {"UPDATE trust_document SET object = (SELECT object FROM loom_profile)", "trust document 1: is [null,"},
};

}  // namespace

TEST_CASE("no row of any table can say what no record of the log tells") {
    FlowSite site;
    live_a_day(site);
    site.flow.reset();
    site.is_tampered = true;
    REQUIRE(all_text(verify_tables(site.path).value()) == "");
    for (const Tampering& one : tamperings) {
        const std::string copy = site.folder.copy(site.path, "copy.db");
        tamper_without_rules(copy, one.sql);
        const auto findings = verify_tables(copy).value();
        INFO(one.sql << "\n" << all_text(findings));
        REQUIRE(has_words(findings, one.words));
    }
}

TEST_CASE("a step that lacks its signature, or has another person's, is told by its record") {
    FlowSite site;
    site.is_tampered = true;
    got(site.flow->designs().add(site.people.at("dora"), site.ask(), "shoe"));
    site.save("dora", {});
    const auto append = [&](const std::string& actor, const std::optional<RecordSignature>& signature) {
        return got(site.flow->store().write([&](Writer& writer) -> Result<Seq> {
            Statement statement{"mill", "revision.submitted",     "2026-11-26T09:00:00.000Z", actor, "shoe",
                                "why",  "request-" + actor + "x", {{"revision", 1}}};
            statement.data["sha256"] = std::string(64, '0');
            return writer.append(statement, signature);
        }));
    };
    const std::string eves = got(site.flow->store().read([&](const Reader& reader) -> Result<std::string> {
        return signing_key(reader, site.people.at("eve").id)->id;
    }));
    const Seq bare = append("dora", {});
    const Seq foreign = append("dora", RecordSignature{eves, std::string(128, '0')});
    const auto findings = verify_tables(site.path).value();
    INFO(all_text(findings));
    CHECK(has_words(findings, "record " + std::to_string(bare) + ": is not signed"));
    CHECK(has_words(findings, "record " + std::to_string(foreign) + ": is signed by a key that was not"));
    CHECK(has_words(findings, "speaks of another revision than that of its number"));
}

TEST_CASE("a record of no kind that is known, and one that lacks a member, are told") {
    FlowSite site;
    site.is_tampered = true;
    got(site.flow->store().write([&](Writer& writer) -> Result<Seq> {
        WEAVE_CHECK_OK(writer.append({"mill", "loom.melted", "2026-11-26T09:00:00.000Z", "ada", {}, {},
                                      "request-x", Json::object()}));
        return writer.append({"mill", "loom.operators_set", "2026-11-26T09:00:00.000Z", "ada", "EP 7", {},
                              "request-y", Json::object()});
    }));
    const auto findings = verify_tables(site.path).value();
    INFO(all_text(findings));
    CHECK(has_words(findings, "is of a kind that this program does not know: loom.melted"));
    CHECK(has_words(findings, "does not tell what its kind has to"));
}

}  // namespace weave::loomlink::testing
