#include "tamper_case.hpp"

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;

TEST_CASE("tree nodes, heads, schema, links and revisions are looked at as well") {
    Mill mill;
    REQUIRE(mill.store.write([&](Writer& writer) -> Status {
        WEAVE_CHECK_OK(mill.approved(writer));
        return {};
    }));
    sign_log(mill.store);
    { const Store closed = std::move(mill.store); }  // a copy is taken of what nobody has open
    const auto found = [&](const std::string& sql, const std::string& words) {
        const std::string copy = mill.folder.copy(mill.path, "copy.db");
        tamper_with(copy, sql);
        const auto findings = verify_store(copy, {log_key().check(), {}, {}}).value();
        INFO(sql << "\n" << all_text(findings));
        REQUIRE(has_words(findings, words));
    };
    found("DROP TRIGGER author_never_approves", "author_never_approves");
    found(
        "DROP TRIGGER transition_no_update; UPDATE transition SET after = 'released' WHERE before = "
        "'submitted' AND "
        "after = 'approved'",
        "transition revision submitted to released");
    found(
        "DROP TRIGGER tree_node_no_update; UPDATE tree_node SET hash = zeroblob(32) WHERE level = 1 AND "
        "position = 0",
        "tree above records 0 to 1");
    found("DROP TRIGGER tree_node_no_delete; DELETE FROM tree_node WHERE level = 1 AND position = 1",
          "tree above records 2 to 3");
    found(
        "DROP TRIGGER tree_head_no_update; UPDATE tree_head SET head = CAST(replace(CAST(head AS TEXT), "
        "'T10', 'T11') AS BLOB)",
        "not signed");
    found("DROP TRIGGER revision_no_update; UPDATE revision SET message = 'other'", "revision 1 of shoe");
    found("DROP TRIGGER revision_no_update; UPDATE revision SET event = 4711", "points at a row of event");
    found(
        "DROP TRIGGER decision_no_update; UPDATE decision SET person = (SELECT id FROM person WHERE login = "
        "'anna')",
        "approved own work");
    found(
        "DROP TRIGGER revision_state_no_update; UPDATE revision_state SET state = 'released' WHERE state = "
        "'submitted'",
        "cannot follow");
}
