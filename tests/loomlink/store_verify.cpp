#include "store_case.hpp"

#include <set>
#include <support/random.hpp>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;
using weave::testing::Random;

namespace {

const TestKey log_key(1), person_key(2);

SignedTreeHead sign_log(Store& store) {
    return store
        .write([](Writer& writer) -> Result<SignedTreeHead> {
            WEAVE_TRY(const std::uint64_t size, writer.log_size());
            WEAVE_TRY(const Hash root, writer.root(size));
            const TreeHead plain{"mill", size, root, "2026-11-26T10:00:00.000Z"};
            const SignedTreeHead head{plain, log_key.sign(head_bytes(plain))};
            WEAVE_CHECK_OK(writer.add_head(head));
            return head;
        })
        .value();
}

/// A closed store of 40 records and some objects, and its last head.
struct Original {
    Folder folder;
    std::filesystem::path path = folder / "store.db";
    std::filesystem::path older = folder / "older.db";  ///< as it was after 20 records
    StoreTrust trust{log_key.check(), person_key.check(), {}};

    Original() {
        Store store = Store::create(path, "mill").value();
        for (std::uint64_t k = 0; k < 40; ++k) {
            const Status status = store.write([&](Writer& writer) -> Status {
                const Statement statement = statement_of(k);
                WEAVE_CHECK_OK(writer.put_object("object " + std::to_string(k)));
                WEAVE_CHECK_OK(writer.append(statement, person_key.sign(statement_bytes(statement))));
                return {};
            });
            REQUIRE(status);
            if (k == 19) {
                sign_log(store);
                REQUIRE(store.backup(older));
            }
        }
        trust.retained = sign_log(store);
    }
};

std::string seq_text(std::size_t seq) {
    return std::to_string(seq);
}

/// SQL that tampers with the log or an object; the record that must be named, or words that must be said.
struct Attempt {
    std::string sql;
    std::set<Seq> touched;
    std::string words;
};

Attempt attempt_of(Random& random) {
    const std::size_t a = random.between(0, 38), b = random.between(a + 1, 39);
    switch (random.between(0, 6)) {
        case 0:  // a bit of a byte, by a function that tamper_with() lends to SQL
            return {"UPDATE event SET record = flip(record, " + seq_text(random.between(0, 100'000)) +
                        ") WHERE seq = " + seq_text(a),
                    {a},
                    ""};
        case 1:
            return {"DELETE FROM event WHERE seq = " + seq_text(a), {a}, ""};
        case 2:
            return {"UPDATE event SET seq = -1 WHERE seq = " + seq_text(a) +
                        "; UPDATE event SET seq = " + seq_text(a) + " WHERE seq = " + seq_text(b) +
                        "; UPDATE event SET seq = " + seq_text(b) + " WHERE seq = -1",
                    {a, b},
                    ""};
        case 3:
            return {"DELETE FROM event WHERE seq >= " + seq_text(b), {b}, ""};
        case 4:
            return {"UPDATE event SET actor = 'mallory' WHERE seq = " + seq_text(a), {a}, ""};
        case 5:
            return {"UPDATE event SET leaf = randomblob(32) WHERE seq = " + seq_text(a), {a}, ""};
        default:
            return {"UPDATE chunk SET bytes = randomblob(length(bytes)) WHERE id = " + seq_text(a + 1),
                    {},
                    "chunk " + seq_text(a + 1)};
    }
}

std::string without_rules(const std::string& sql) {
    return "PRAGMA ignore_check_constraints = ON; DROP TRIGGER event_no_update; DROP TRIGGER "
           "event_no_delete; DROP TRIGGER chunk_no_update; " +
           sql;
}

bool has_words(const std::vector<AuditFinding>& findings, const std::string& words) {
    return std::any_of(findings.begin(), findings.end(), [&](const AuditFinding& finding) {
        return finding.text().find(words) != std::string::npos;
    });
}

void tamper(std::size_t attempts) {
    const Original original;
    REQUIRE(all_text(verify_store(original.path, original.trust).value()).empty());
    const auto copy = original.folder / "copy.db";
    std::size_t changed = 0;
    weave::testing::for_all(
        [&](Random& random) {
            std::filesystem::copy_file(original.path, copy,
                                       std::filesystem::copy_options::overwrite_existing);
            const Attempt attempt = attempt_of(random);
            tamper_with(copy, without_rules(attempt.sql));
            const auto findings = verify_store(copy, original.trust).value();
            INFO(attempt.sql << "\n" << all_text(findings));
            // the rules that had to be dropped are missed in any case; here the record itself counts
            bool named = !attempt.words.empty() && has_words(findings, attempt.words);
            for (const Seq seq : attempt.touched) named = named || names_record(findings, seq);
            REQUIRE(named);
            ++changed;
        },
        attempts);
    REQUIRE(changed == attempts);
}

}  // namespace

TEST_CASE("random tampering with the records and objects in the file is found, and the record named") {
    tamper(300);
}

TEST_CASE("10,000 random tamperings with the file are found, and the record named", "[.][long]") {
    tamper(10000);
}

TEST_CASE("an older copy of the store is found by the retained head") {
    const Original original;
    StoreTrust trust = original.trust;
    REQUIRE(names_record(verify_store(original.older, trust).value(), 20));
    trust.retained.reset();
    REQUIRE(all_text(verify_store(original.older, trust).value()).empty());
}

TEST_CASE(
    "a store that somebody rewrote as a whole, tree and all, is found by its signatures and the retained "
    "head") {
    const Original original;
    const Folder folder;
    {
        Store forged = Store::create(folder / "s.db", "mill").value();
        for (std::uint64_t k = 0; k < 40; ++k)
            REQUIRE(forged.write([&](Writer& writer) { return note(writer, k + 1); }));
    }
    const auto findings = verify_store(folder / "s.db", original.trust).value();
    REQUIRE(has_words(findings, "retained head"));
}

TEST_CASE("tree nodes, heads, schema, links and revisions are looked at as well") {
    Mill mill;
    REQUIRE(mill.store.write([&](Writer& writer) -> Status {
        WEAVE_CHECK_OK(mill.approved(writer));
        return {};
    }));
    sign_log(mill.store);
    const auto found = [&](const std::string& sql, const std::string& words) {
        const auto copy = mill.folder / "copy.db";
        std::filesystem::remove(copy);
        REQUIRE(mill.store.backup(copy));
        tamper_with(copy, sql);
        const auto findings = verify_store(copy, {log_key.check(), {}, {}}).value();
        INFO(sql << "\n" << all_text(findings));
        REQUIRE(has_words(findings, words));
    };
    found("DROP TRIGGER author_never_approves", "author_never_approves");
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
