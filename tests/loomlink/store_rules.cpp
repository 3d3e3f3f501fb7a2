#include "store_case.hpp"

#include <support/random.hpp>
#include <thread>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;

namespace {

/// What a write of the mill answers, as text; empty where it was done.
template <class Change>
std::string outcome(Mill& mill, Change change) {
    return text_of(mill.store.write([&](Writer& writer) -> Status { return change(writer); }));
}

}  // namespace

TEST_CASE("a store is made once, and opened by its own program alone") {
    const Folder folder;
    const auto path = folder.store("s.db");
    REQUIRE_FALSE(Store::open(path));
    { const Store store = Store::create(path, "mill").value(); }
    REQUIRE_THAT(text_of(Store::create(path, "mill")), Catch::Contains("exists already"));
    REQUIRE(Store::open(path));
    tamper_with(folder.store("other.db"), "CREATE TABLE t (x)");
    REQUIRE_THAT(text_of(Store::open(folder.store("other.db"))), Catch::Contains("another program"));
    tamper_with(path, "PRAGMA user_version = 99");
    REQUIRE_THAT(text_of(Store::open(path)), Catch::Contains("version 99"));
}

TEST_CASE("records follow one another, and proofs come out of the store") {
    Mill mill;
    const TestKey log(1);
    REQUIRE(outcome(mill, [](Writer& writer) -> Status {
                for (std::uint64_t k = 0; k < 40; ++k) WEAVE_CHECK_OK(note(writer, k));
                return {};
            }).empty());
    const auto head = mill.store.write([&](Writer& writer) -> Result<SignedTreeHead> {
        WEAVE_TRY(const std::uint64_t size, writer.log_size());
        WEAVE_TRY(const Hash root, writer.root(size));
        const TreeHead plain{"mill", size, root, "2026-11-26T10:00:00.000Z"};
        const SignedTreeHead signed_head{plain, log.sign(head_bytes(plain))};
        WEAVE_CHECK_OK(writer.add_head(signed_head));
        return signed_head;
    });
    REQUIRE(head);
    const AuditBundle bundle =
        mill.store.read([](const Reader& reader) { return reader.bundle(); }).value().value();
    REQUIRE(bundle.head == *head);
    const BundleReport report = verify_bundle(write_bundle(bundle), {log.check(), *head, {}});
    INFO(all_text(report.findings));
    REQUIRE(report.clean());
    REQUIRE(report.records == 41);
    const auto proof = mill.store.read([](const Reader& reader) { return reader.inclusion(17, 41); }).value();
    REQUIRE(verify_inclusion(17, 41, bundle.leaves[17], proof, head->head.root));
    const auto growth =
        mill.store.read([](const Reader& reader) { return reader.consistency(13, 41); }).value();
    const Hash old_root = mill.store.read([](const Reader& reader) { return reader.root(13); }).value();
    REQUIRE(verify_consistency(13, old_root, 41, head->head.root, growth));
    REQUIRE_FALSE(mill.store.read([](const Reader& reader) { return reader.root(42); }));

    SignedTreeHead wrong = *head;
    wrong.head.root[0] ^= 1;
    REQUIRE_THAT(outcome(mill, [&](Writer& writer) { return writer.add_head(wrong); }),
                 Catch::Contains("root"));
    REQUIRE_THAT(outcome(mill,
                         [](Writer& writer) -> Status {
                             WEAVE_CHECK_OK(writer.append(statement_of(1, "other")));
                             return {};
                         }),
                 Catch::Contains("another site"));
    const auto about = mill.store.read([](const Reader& reader) {
        return reader.events({0, 100, {}, "shoe/7"});
    });
    REQUIRE(about.value().size() == 1);
}

TEST_CASE("a change that is refused leaves nothing, and takes no other with it") {
    Mill mill;
    const auto size = [&] {
        return mill.store.read([](const Reader& reader) { return reader.log_size(); }).value();
    };
    const auto before = size();
    REQUIRE_THAT(outcome(mill,
                         [&](Writer& writer) -> Status {
                             WEAVE_CHECK_OK(note(writer));
                             WEAVE_CHECK_OK(writer.put_object("lost"));
                             return Error{ErrorCode::refused, "changed my mind", {}};
                         }),
                 Catch::Contains("changed my mind"));
    REQUIRE_THAT(outcome(mill, [](Writer&) -> Status { throw std::runtime_error("slip"); }),
                 Catch::Contains("slip"));
    REQUIRE(size() == before);
    REQUIRE_FALSE(
        mill.store.read([](const Reader& reader) { return reader.has_object(sha256("lost")); }).value());

    std::vector<std::thread> writers;
    std::atomic<int> done = 0, refused = 0;
    for (int k = 0; k < 8; ++k) {
        writers.emplace_back([&, k] {
            for (int n = 0; n < 20; ++n) {
                const Status status = mill.store.write([&](Writer& writer) -> Status {
                    WEAVE_CHECK_OK(note(writer));
                    if ((n + k) % 3 == 0) return Error{ErrorCode::refused, "no", {}};
                    return {};
                });
                ++(status ? done : refused);
            }
        });
    }
    for (std::thread& writer : writers) writer.join();
    REQUIRE(done + refused == 160);
    REQUIRE(size() == before + static_cast<std::uint64_t>(done));
    REQUIRE(all_text(verify_store(mill.path).value()).empty());
}

TEST_CASE("a revision is numbered, hashed and found by all its names") {
    Mill mill;
    const auto made = mill.store.write([&](Writer& writer) -> Result<std::pair<Revision, Revision>> {
        WEAVE_TRY(const Revision first, mill.draft(writer, mill.anna));
        WEAVE_TRY(const Revision second, mill.draft(writer, mill.bert, {first.id}));
        WEAVE_CHECK_OK(writer.move_branch({mill.shoe, "main", second.id, second.event}, {}));
        return std::pair(first, second);
    });
    REQUIRE(made);
    const auto& [first, second] = *made;
    REQUIRE(first.number == 1);
    REQUIRE(second.number == 2);
    REQUIRE(second.parents == std::vector<Id>{first.id});
    REQUIRE(second.authors == std::vector<Id>{mill.anna, mill.bert});
    REQUIRE(second.state == RevisionState::draft);
    REQUIRE(second.hash == revision_hash(second, "shoe", "bert", {first.hash}));
    Revision other = second;
    other.message += ".";
    REQUIRE(revision_hash(other, "shoe", "bert", {first.hash}) != second.hash);
    REQUIRE(
        mill.store.read([&](const Reader& reader) { return reader.revision(mill.shoe, 2); }).value()->id ==
        second.id);
    REQUIRE(
        mill.store.read([&](const Reader& reader) { return reader.revisions(mill.shoe); }).value().size() ==
        2);
    REQUIRE(mill.store.read([&](const Reader& reader) { return reader.branches(mill.shoe); })
                .value()
                .front()
                .head == second.id);
    const Branch back{mill.shoe, "main", first.id, 1};
    REQUIRE_THAT(outcome(mill, [&](Writer& writer) { return writer.move_branch(back, first.id); }),
                 Catch::Contains("somebody else"));
    REQUIRE_THAT(outcome(mill, [&](Writer& writer) { return writer.move_branch(back, {}); }),
                 Catch::Contains("somebody else"));
    REQUIRE(outcome(mill, [&](Writer& writer) { return writer.move_branch(back, second.id); }).empty());
}

TEST_CASE("an author never approves own work: the database itself refuses") {
    Mill mill;
    const auto try_to_approve = [&](Id author, std::vector<Id> parents, Id who) {
        return outcome(mill, [&](Writer& writer) -> Status {
            WEAVE_TRY(const Revision revision, mill.draft(writer, author, parents));
            WEAVE_CHECK_OK(Mill::go(writer, revision.id, RevisionState::submitted));
            return Mill::decide(writer, revision.id, who);
        });
    };
    REQUIRE_THAT(try_to_approve(mill.anna, {}, mill.anna), Catch::Contains("own work"));
    REQUIRE(try_to_approve(mill.anna, {}, mill.bert).empty());

    Revision berts, approved;
    REQUIRE(outcome(mill, [&](Writer& writer) -> Status {
                WEAVE_TRY(berts, mill.draft(writer, mill.bert));
                WEAVE_TRY(approved, mill.approved(writer));
                return {};
            }).empty());
    // what is built on bert's draft is his work too; on what was approved, it is not anna's any more
    REQUIRE_THAT(try_to_approve(mill.cleo, {berts.id}, mill.bert), Catch::Contains("own work"));
    REQUIRE_THAT(try_to_approve(mill.cleo, {approved.id, berts.id}, mill.bert), Catch::Contains("own work"));
    REQUIRE(try_to_approve(mill.cleo, {approved.id}, mill.anna).empty());
}

TEST_CASE("every pair of states is allowed or refused as the table says") {
    using enum RevisionState;
    const std::vector<std::pair<RevisionState, RevisionState>> allowed{
        {draft, submitted},   {submitted, approved},  {submitted, changes_requested},
        {approved, released}, {released, superseded}, {released, withdrawn}};
    const std::vector<std::vector<RevisionState>> ways{{},
                                                       {submitted},
                                                       {submitted, approved},
                                                       {submitted, changes_requested},
                                                       {submitted, approved, released},
                                                       {submitted, approved, released, superseded},
                                                       {submitted, approved, released, withdrawn}};
    Mill mill;
    for (const auto& way : ways) {
        for (const RevisionState to :
             {draft, submitted, approved, changes_requested, released, superseded, withdrawn}) {
            const RevisionState from = way.empty() ? draft : way.back();
            const std::string said = outcome(mill, [&](Writer& writer) -> Status {
                WEAVE_TRY(const Revision revision, mill.draft(writer, mill.anna));
                for (const RevisionState state : way) {
                    WEAVE_CHECK_OK(Mill::go(writer, revision.id, state));
                    if (state == submitted) WEAVE_CHECK_OK(Mill::decide(writer, revision.id, mill.bert));
                }
                return Mill::go(writer, revision.id, to);
            });
            INFO(word(from) << " to " << word(to) << ": " << said);
            const bool may = std::find(allowed.begin(), allowed.end(), std::pair(from, to)) != allowed.end();
            REQUIRE(said.empty() == may);
            if (!may)
                REQUIRE_THAT(said, Catch::Contains("cannot go") || Catch::Contains("nobody has approved"));
        }
    }
    REQUIRE_THAT(outcome(mill,
                         [&](Writer& writer) -> Status {
                             WEAVE_TRY(const Revision revision, mill.draft(writer, mill.anna));
                             WEAVE_CHECK_OK(Mill::go(writer, revision.id, submitted));
                             return Mill::go(writer, revision.id, approved);
                         }),
                 Catch::Contains("nobody has approved"));
}

TEST_CASE("only what is approved and signed is released, and its files stay") {
    Mill mill;
    Release release;
    const auto make = [&](Writer& writer, const Revision& revision) -> Result<Release> {
        WEAVE_TRY(const Seq event, note(writer));
        Release wish;
        wish.loom = mill.loom;
        wish.revision = revision.id;
        wish.profile_version = 1;
        wish.feeders = "{}";
        WEAVE_TRY(wish.manifest, writer.put_object("manifest"));
        WEAVE_TRY(const Hash card, writer.put_object("card bytes"));
        wish.files = {{"card.ep", card, 0}};
        wish.event = event;
        return writer.add_release(wish);
    };
    REQUIRE_THAT(outcome(mill,
                         [&](Writer& writer) -> Status {
                             WEAVE_TRY(const Revision revision, mill.draft(writer, mill.anna));
                             WEAVE_CHECK_OK(make(writer, revision));
                             return {};
                         }),
                 Catch::Contains("only an approved revision"));
    REQUIRE(outcome(mill, [&](Writer& writer) -> Status {
                WEAVE_TRY(const Revision revision, mill.approved(writer));
                WEAVE_TRY(release, make(writer, revision));
                return {};
            }).empty());
    REQUIRE(release.number == 1);
    REQUIRE(release.files.front().size == 10);
    const auto go = [&](ReleaseStage state) {
        return outcome(mill, [&](Writer& writer) -> Status {
            WEAVE_TRY(const Seq event, note(writer));
            return writer.set_release_state(release.id, state, event);
        });
    };
    REQUIRE_THAT(go(ReleaseStage::released), Catch::Contains("nobody has signed"));
    REQUIRE_THAT(go(ReleaseStage::superseded), Catch::Contains("cannot go"));
    const ReleaseSignature signature{Mill::key_id(), std::string(128, 'b'), 1};
    REQUIRE(
        outcome(mill, [&](Writer& writer) { return writer.sign_release(release.id, signature); }).empty());
    REQUIRE(go(ReleaseStage::released).empty());
    REQUIRE(go(ReleaseStage::withdrawn).empty());
    REQUIRE_THAT(go(ReleaseStage::released), Catch::Contains("cannot go"));
    const auto found =
        mill.store.read([&](const Reader& reader) { return reader.releases(mill.loom); }).value();
    REQUIRE(found.front().state == ReleaseStage::withdrawn);
    REQUIRE(found.front().signatures.size() == 1);
    REQUIRE(mill.store.read([&](const Reader& reader) { return reader.release_steps(release.id); })
                .value()
                .size() == 3);
    REQUIRE(all_text(verify_store(mill.path).value()).empty());
}

TEST_CASE("people, keys, sessions and answers to requests") {
    Mill mill;
    const auto anna =
        mill.store.read([](const Reader& reader) { return reader.person("anna"); }).value().value();
    REQUIRE(anna.roles == std::vector{PersonRole::designer});
    REQUIRE_THAT(outcome(mill,
                         [&](Writer& writer) -> Status {
                             WEAVE_CHECK_OK(writer.add_person(anna));
                             return {};
                         }),
                 Catch::Contains("exists already"));
    Person changed = anna;
    changed.active = false;
    changed.roles = {PersonRole::approver, PersonRole::engineer};
    REQUIRE(outcome(mill, [&](Writer& writer) { return writer.update_person(changed); }).empty());
    const auto now =
        mill.store.read([&](const Reader& reader) { return reader.person(mill.anna); }).value().value();
    REQUIRE_FALSE(now.active);
    REQUIRE(now.roles.size() == 2);

    REQUIRE(outcome(mill, [&](Writer& writer) { return writer.reseal_key(Mill::key_id(), "anew"); }).empty());
    REQUIRE(outcome(mill, [&](Writer& writer) { return writer.revoke_key(Mill::key_id(), 0); }).empty());
    REQUIRE_FALSE(
        outcome(mill, [&](Writer& writer) { return writer.reseal_key(Mill::key_id(), "again"); }).empty());
    const auto key =
        mill.store.read([](const Reader& reader) { return reader.key(Mill::key_id()); }).value().value();
    REQUIRE(key.sealed == "anew");
    REQUIRE(key.revoked == 0);

    const Session session{sha256("token"), mill.anna, "2026-11-26T10:00:00.000Z", "csrf"};
    REQUIRE(outcome(mill, [&](Writer& writer) { return writer.add_session(session); }).empty());
    const auto at = [&](const std::string& moment) {
        return mill.store.read([&](const Reader& reader) { return reader.session(session.token, moment); })
            .value();
    };
    REQUIRE(at("2026-11-26T09:59:59.999Z"));
    REQUIRE_FALSE(at("2026-11-26T10:00:00.000Z"));
    REQUIRE(outcome(mill, [&](Writer& writer) { return writer.end_sessions(mill.anna); }).empty());
    REQUIRE_FALSE(at("2026-11-26T09:00:00.000Z"));

    REQUIRE(
        outcome(mill, [&](Writer& writer) { return writer.record_answer("r1", mill.anna, "{}"); }).empty());
    REQUIRE_THAT(outcome(mill, [&](Writer& writer) { return writer.record_answer("r1", mill.anna, "{}"); }),
                 Catch::Contains("exists already"));
    REQUIRE(mill.store.read([&](const Reader& reader) { return reader.answer("r1", mill.anna); }).value() ==
            "{}");
    REQUIRE_THAT(
        text_of(mill.store.read([&](const Reader& reader) { return reader.answer("r1", mill.bert); })),
        Catch::Contains("somebody else"));
}

TEST_CASE("the database refuses to change or remove what is kept") {
    Mill mill;
    REQUIRE(outcome(mill, [&](Writer& writer) -> Status {
                WEAVE_CHECK_OK(mill.approved(writer));
                return {};
            }).empty());
    for (const auto& [table, column] :
         std::vector<std::pair<std::string, std::string>>{{"event", "record"},
                                                          {"chunk", "bytes"},
                                                          {"object", "hash"},
                                                          {"object_chunk", "chunk"},
                                                          {"revision", "message"},
                                                          {"revision_state", "state"},
                                                          {"revision_author", "person"},
                                                          {"decision", "person"},
                                                          {"design", "name"},
                                                          {"loom_profile", "object"},
                                                          {"transition", "after"},
                                                          {"site", "name"},
                                                          {"tree_node", "hash"}}) {
        INFO(table);
        REQUIRE_THROWS_WITH(tamper_with(mill.path, "DELETE FROM " + table), Catch::Contains("not changed"));
        REQUIRE_THROWS_WITH(tamper_with(mill.path, "UPDATE " + table + " SET " + column + " = " + column),
                            Catch::Contains("not changed"));
    }
    REQUIRE_THROWS_WITH(
        tamper_with(
            mill.path,
            "INSERT INTO event (seq, record, leaf, kind, actor) VALUES (99, x'', zeroblob(32), 'a', 'a')"),
        Catch::Contains("number after the last"));
}
