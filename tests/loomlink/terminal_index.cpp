#include "site.hpp"

#include <weave/keys/members.hpp>

#include <catch2/catch.hpp>

#include <support/random.hpp>

using namespace weave;
using namespace weave::loomlink;
using testing::check_forbidden;
using testing::check_forged;
using testing::check_refused;
using testing::Site;

namespace {

/// A terminal that took the index of epoch 10 with two releases at minute 0.
struct Used {
    Site site;
    TerminalState state = taken(site.terminal(), site.index(10, 2, 0), 1);

    [[nodiscard]] Result<CheckedIndex> check(const std::string& bytes, int minutes) const {
        return check_index(state, bytes, Site::at(minutes), Site::consistent);
    }
    /// The next honest index, changed and signed by the stamp key all the same.
    [[nodiscard]] Result<CheckedIndex> stamped(const std::function<void(ReleaseIndex&)>& change) const {
        ReleaseIndex index = site.index_terms(20, 3, 30);
        change(index);
        return check(site.sign_index(index), 31);
    }
    static TerminalState taken(const TerminalState& state, const std::string& bytes, int minutes) {
        return check_index(state, bytes, Site::at(minutes), Site::consistent).value().state;
    }
};

}  // namespace

TEST_CASE("an honest index is taken and remembered") {
    const Used used;
    CHECK(used.state.releases.size() == 2);
    CHECK(used.state.stamps.size() == 1);
    CHECK(used.state.stamps[0].epoch == 10);
    CHECK(used.state.tree_head->head.size == 12);
    CHECK(used.state.last_seen == Site::at(1));
    const CheckedIndex next = used.check(used.site.index(20, 3, 30), 31).value();
    CHECK(next.index.releases.size() == 3);
    CHECK(next.state.stamps[0].epoch == 20);
    CHECK(next.state.tree_head->head.size == 22);
    CHECK(used.check(used.site.index(10, 2, 30), 31));  // nothing new, freshly stamped
    CHECK(used.check(used.site.index(10, 2, 0), 1));    // the very same again
}

TEST_CASE("a forged index is refused, whoever forged it") {
    const Used used;
    const Json body = index_body(used.site.index_terms(20, 3, 30));
    const auto signed_by = [&](Purpose purpose, const KeyPair& pair) {
        return used.check(Site::sign(purpose, body, {&pair}), 31);
    };
    REQUIRE(signed_by(Purpose::release_index, used.site.stamp));
    check_forged(signed_by(Purpose::release_index, used.site.thief), "does not know: unknown or revoked");
    check_forged(signed_by(Purpose::release_index, used.site.anna), "does not have the role stamp");
    check_forged(signed_by(Purpose::release_index, used.site.log), "does not have the role stamp");
    check_forged(signed_by(Purpose::tree_head, used.site.stamp), "forged or altered");
    check_forged(
        used.check(Site::sign(Purpose::release_index, body, {&used.site.stamp, &used.site.thief}), 31),
        "unknown or revoked");
}

TEST_CASE("an index for others is refused") {
    const Used used;
    check_refused(used.stamped([](auto& i) { i.site = "other mill"; }),
                  "is an index of the site 'other mill'");
    check_refused(used.stamped([](auto& i) { i.loom = "loom 8"; }),
                  "for the loom 'loom 8', not for 'loom 7'");
    check_refused(used.stamped([](auto& i) { i.trust = 2; }), "fetch the trust documents first");
}

TEST_CASE("rollback: an older epoch is refused, and so is an older stamp of the same one") {
    const Used used;
    check_forbidden(used.check(used.site.index(9, 2, 30), 31), "an old one is being replayed");
    check_forbidden(used.check(used.site.index(10, 2, -5), 1), "before one that this terminal has seen");
    check_forbidden(used.check(used.site.index(10, 3, 30), 31),
                    "lists other releases than the index of the same epoch");
}

TEST_CASE("freeze: an index that has run out is refused, and a clock that was turned back does not save it") {
    const Used used;
    CHECK(used.check(used.site.index(20, 3, 30), 89));
    check_refused(used.check(used.site.index(20, 3, 30), 90), "has run out");
    check_refused(used.check(used.site.index(20, 3, 30), 2000), "has run out");
    CHECK(used.check(used.site.index(10, 2, 0), -3));  // clocks differ a little
    check_refused(used.check(used.site.index(10, 2, 0), -6), "the clock of this terminal stands at");
    check_refused(used.check(used.site.index(20, 3, 30), 24), "is from the future");
    CHECK(used.check(used.site.index(20, 3, 30), 26));
}

TEST_CASE("no stamp holds for long, whatever it says") {
    const Used used;
    check_refused(
        used.stamped([](auto& i) { i.expires = i.issued + longest_validity + std::chrono::minutes(1); }),
        "no index may hold for so long");
    CHECK(used.stamped([](auto& i) { i.expires = i.issued + longest_validity; }));
    check_refused(used.stamped([](auto& i) { i.expires = i.issued; }), "must be later than it was issued");
}

TEST_CASE("fast-forward: an epoch beyond the log that it shows is refused") {
    const Used used;
    check_forbidden(used.stamped([](auto& i) { i.epoch = 23; }),
                    "but its log has only 22 records: it runs ahead");
    CHECK(used.stamped([](auto& i) { i.epoch = 22; }));
    check_forbidden(used.stamped([](auto& i) { i.epoch = static_cast<std::uint64_t>(most_count); }),
                    "it runs ahead");
    check_forged(used.stamped([&](auto& i) {
        i.epoch = 1000;
        i.tree_head = used.site.head(1000, used.site.stamp);  // who has the stamp key alone
    }),
                 "does not have the role log");
}

TEST_CASE("a log that is not the one seen before is refused") {
    const Used used;
    check_refused(used.stamped([&](auto& i) {
        i.epoch = 11;
        i.tree_head = used.site.head(11, used.site.log);
    }),
                  "records were taken away or an old log is shown");
    const auto forked = [&](std::uint64_t size) {
        return sign_head(used.site.log, {Site::name, size, sha256_hex("fork"), Site::at(0)});
    };
    check_refused(used.stamped([&](auto& i) {
        i.epoch = 12;
        i.tree_head = forked(12);
    }),
                  "history was rewritten");
    check_refused(used.stamped([&](auto& i) { i.tree_head = forked(22); }),
                  "does not go on from the one seen before");
    const auto unproven = check_index(used.state, used.site.index(20, 3, 30), Site::at(31), {});
    check_refused(unproven, "without a proof that its log goes on");
}

TEST_CASE("releases that were seen neither vanish nor change nor come back") {
    Used used;
    check_refused(used.stamped([](auto& i) { i.releases.erase(i.releases.begin()); }),
                  "does not list release 1 any more");
    check_refused(used.stamped([](auto& i) { i.releases.pop_back(), i.releases.pop_back(); }),
                  "does not list release 2 any more");
    check_refused(used.stamped([](auto& i) { i.releases[1].revision_sha256 = Site::revision(9); }),
                  "with another revision");
    ReleaseIndex recall = used.site.index_terms(15, 2, 10);
    recall.releases[0].state = ReleaseState::withdrawn;
    recall.releases[1].state = ReleaseState::superseded;
    used.state = Used::taken(used.state, used.site.sign_index(recall), 11);
    check_refused(used.check(used.site.index(20, 3, 30), 31),
                  "calls release 1 released, but it was withdrawn");
    check_refused(used.stamped([](auto& i) {
        i.releases[0].state = ReleaseState::withdrawn;
        i.releases[1].state = ReleaseState::released;
    }),
                  "calls release 2 released, but it was superseded");
    CHECK(used.stamped([](auto& i) { i.releases[0].state = i.releases[1].state = ReleaseState::withdrawn; }));
}

TEST_CASE("an index in bad form is refused with its place") {
    const Used used;
    const auto body = [&](const std::function<void(Json&)>& change) {
        Json json = index_body(used.site.index_terms(20, 3, 30));
        change(json);
        return used.check(Site::sign(Purpose::release_index, json, {&used.site.stamp}), 31);
    };
    check_forged(body([](Json& j) { j["version"] = 2; }), "newer than this program");
    check_forged(body([](Json& j) { j["format"] = "other"; }), "must be weave-release-index");
    check_forged(body([](Json& j) { j["releases"][0]["state"] = "gone"; }), "index.body.releases[0].state");
    check_forged(body([](Json& j) { j["releases"][1]["number"] = 1; }),
                 "must be greater than the number before");
    check_forged(body([](Json& j) { j["releases"][1]["more"] = 1; }), "is not known here");
    check_forged(body([](Json& j) { j["epoch"] = -1; }), "index.body.epoch");
    check_forged(body([](Json& j) { j.erase("tree_head"); }), "tree_head");
    check_forged(used.check(std::string(most_index_bytes + 1, ' '), 31), "is too large");
}

TEST_CASE("a flipped bit anywhere in an index is refused") {
    const Used used;
    const std::string bytes = used.site.index(20, 3, 30);
    REQUIRE(used.check(bytes, 31));
    testing::for_all(
        [&](testing::Random& random) {
            std::string changed = bytes;
            const std::size_t at = random.between(0, bytes.size() - 1);
            changed[at] = static_cast<char>(changed[at] ^ (1 << random.between(0, 7)));
            REQUIRE_FALSE(used.check(changed, 31));
            REQUIRE_FALSE(used.check(bytes.substr(0, at), 31));
        },
        testing::property_cases() / 10);
}

TEST_CASE("a new stamp key does not go behind the old one while both count") {
    Used used;
    TrustDocument terms = used.site.trust_terms(2);
    terms.keys.push_back({used.site.thief.public_key(), "loomlink", {Role::stamp}});
    const std::vector<std::string> documents{Site::sign_trust(terms, {&used.site.anna, &used.site.ben})};
    used.state = adopt_trust(used.state, documents).value();
    ReleaseIndex index = used.site.index_terms(9, 2, 30);
    index.trust = 2;
    index.tree_head = used.site.head(30, used.site.log);
    const auto by_new_key = [&] {
        return used.check(Site::sign(Purpose::release_index, index_body(index), {&used.site.thief}), 31);
    };
    check_refused(by_new_key(), "an old one is being replayed");
    index.epoch = 11;
    const TerminalState next = by_new_key().value().state;
    CHECK(next.stamps.size() == 2);
    CHECK(next.stamps[0].key < next.stamps[1].key);
    check_refused(used.check(used.site.index(11, 2, 30), 31), "which version 2 has replaced");
}

TEST_CASE("what a stolen stamp key told is forgotten when it is revoked, and what people signed is not") {
    Used used;
    const std::string body = sha256_hex("signed by people");
    used.state.releases[0].body_sha256 = body;
    ReleaseIndex lies = used.site.index_terms(20, 4, 30);  // by the thief of stamp and log key
    lies.epoch = 1'000'000;
    lies.tree_head =
        sign_head(used.site.log, {Site::name, 1'000'000, Site::root_of(1'000'000), Site::at(30)});
    lies.releases[0].state = ReleaseState::withdrawn;
    lies.releases.back().number = 999;
    used.state = Used::taken(used.state, used.site.sign_index(lies), 31);
    check_refused(used.check(used.site.index(21, 3, 32), 33), "an old one is being replayed");

    const KeyPair stamp = KeyPair::generate(), log = KeyPair::generate();
    TrustDocument terms = used.site.trust_terms(2);
    terms.keys[3].public_key = stamp.public_key();
    terms.keys[4].public_key = log.public_key();
    const std::vector<std::string> documents{Site::sign_trust(terms, {&used.site.anna, &used.site.ben})};
    used.state = adopt_trust(used.state, documents).value();
    CHECK(used.state.stamps.empty());
    CHECK_FALSE(used.state.tree_head);
    REQUIRE(used.state.releases.size() == 1);
    CHECK(used.state.releases[0].body_sha256 == body);
    ReleaseIndex honest = used.site.index_terms(22, 3, 40);
    honest.trust = 2;
    honest.tree_head = used.site.head(24, log);
    CHECK(used.check(Site::sign(Purpose::release_index, index_body(honest), {&stamp}), 41));
    check_refused(used.check(Site::sign(Purpose::release_index, index_body(honest), {&used.site.stamp}), 41),
                  "unknown or revoked");
}

TEST_CASE("newer trust without a new stamp key forgets nothing") {
    const Used used;
    const std::vector<std::string> documents{
        Site::sign_trust(used.site.trust_terms(2), {&used.site.anna, &used.site.ben})};
    const TerminalState next = adopt_trust(used.state, documents).value();
    CHECK(next.trust.version == 2);
    CHECK(next.stamps == used.state.stamps);
    CHECK(next.releases == used.state.releases);
    CHECK(next.tree_head == used.state.tree_head);
    check_refused(adopt_trust(next, documents), "never go back");
}
