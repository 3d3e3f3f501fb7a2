#include "site.hpp"

#include <weave/keys/hex.hpp>

#include <catch2/catch.hpp>

#include <support/random.hpp>

using namespace weave;
using namespace weave::loomlink;
using testing::check_refused;
using testing::Site;

TEST_CASE("a trust document is read as it was written") {
    const Site site;
    const TrustDocument trust = read_trust(site.trust_bytes()).value();
    CHECK(trust.version == 1);
    CHECK(trust.site == "mill");
    CHECK(trust.keys.size() == 5);
    CHECK(canonical_json(trust_body(trust)) == canonical_json(trust.document.body));
    CHECK(write_signed(trust.document) == site.trust_bytes());
    CHECK(trust.fingerprint() == sha256_hex(canonical_json(trust_body(site.trust_terms()))));
    CHECK(trust.find(site.carl.id())->person == "carl");
    CHECK(trust.find(site.thief.id()) == nullptr);
}

TEST_CASE("a trust document stands on enough different roots of its own") {
    Site site;
    TrustDocument terms = site.trust_terms();
    check_refused(read_trust(Site::sign_trust(terms, {&site.anna})),
                  "must be signed by 2 different people, and by 1 is");
    check_refused(read_trust(Site::sign_trust(terms, {&site.anna, &site.carl})), "2 different people");
    check_refused(read_trust(Site::sign_trust(terms, {&site.anna, &site.thief})), "2 different people");
    terms.keys.push_back({site.thief.public_key(), "anna", {Role::root}});  // a second key of one person
    check_refused(read_trust(Site::sign_trust(terms, {&site.anna, &site.thief})), "2 different people");
    CHECK(read_trust(Site::sign_trust(terms, {&site.anna, &site.thief, &site.ben})));
}

TEST_CASE("a key counts once, however often its signature stands there") {
    const Site site;
    SignedDocument document{trust_body(site.trust_terms()), {}};
    const Signature anna = sign_body(site.anna, Purpose::trust_document, document.body);
    document.signatures = {anna, anna};
    check_refused(read_trust(write_signed(document)), "a key counts once");
}

TEST_CASE("trust goes on to the next version by the roots of both, and to no other") {
    Site site;
    const TrustDocument first = site.trust();
    TrustDocument second = site.trust_terms(2);
    second.keys[1] = {site.thief.public_key(), "dora", {Role::root, Role::release}};  // Dora follows Ben
    const KeyPair& dora = site.thief;
    CHECK(next_trust(first, Site::sign_trust(second, {&site.anna, &site.ben, &dora})).value().version == 2);
    check_refused(next_trust(first, Site::sign_trust(second, {&site.anna, &dora})),
                  "by the rule of version 1");
    check_refused(next_trust(first, Site::sign_trust(second, {&site.anna, &site.ben})),
                  "must be signed by 2");
    check_refused(next_trust(first, Site::sign_trust(second, {&site.anna, &site.ben, &dora, &site.carl})),
                  "which is no root");
    check_refused(next_trust(first, Site::sign_trust(site.trust_terms(3), {&site.anna, &site.ben})),
                  "does not follow version 1");
    check_refused(next_trust(first, site.trust_bytes()), "never go back");
    TrustDocument foreign = site.trust_terms(2);
    foreign.site = "other mill";
    check_refused(next_trust(first, Site::sign_trust(foreign, {&site.anna, &site.ben})),
                  "is of the site 'other mill'");
}

TEST_CASE("a thief's own document, however it is signed, follows nothing") {
    Site site;
    TrustDocument forged = site.trust_terms(2);
    forged.keys = {{site.thief.public_key(), "anna", {Role::root, Role::release}},
                   {site.stamp.public_key(), "loomlink", {Role::stamp}},
                   {site.log.public_key(), "loomlink", {Role::log}}};
    forged.root_threshold = forged.release_threshold = 1;
    const std::string alone = Site::sign_trust(forged, {&site.thief});
    REQUIRE(read_trust(alone));
    check_refused(next_trust(site.trust(), alone), "by the rule of version 1");
    SignedDocument stolen{trust_body(forged), {}};
    for (const auto* pair : {&site.anna, &site.ben})  // signatures of something else
        stolen.signatures.push_back(
            sign_body(*pair, Purpose::trust_document, trust_body(site.trust_terms())));
    stolen.signatures.push_back(sign_body(site.thief, Purpose::trust_document, stolen.body));
    check_refused(next_trust(site.trust(), write_signed(stolen)), "does not fit: forged or altered");
    stolen.signatures.resize(0);
    for (const auto* pair : {&site.anna, &site.ben, &site.thief})  // right keys, another purpose
        stolen.signatures.push_back(sign_body(*pair, Purpose::statement, stolen.body));
    check_refused(next_trust(site.trust(), write_signed(stolen)), "does not fit");
}

TEST_CASE("a chain is followed to its end, and an error says where it breaks") {
    Site site;
    std::vector<std::string> chain;
    for (std::uint64_t version = 2; version <= 6; ++version)
        chain.push_back(Site::sign_trust(site.trust_terms(version), {&site.anna, &site.ben}));
    CHECK(follow_trust(site.trust(), chain).value().version == 6);
    CHECK(follow_trust(site.trust(), {}).value().version == 1);
    std::swap(chain[1], chain[2]);
    check_refused(follow_trust(site.trust(), chain), "documents[1]");
}

TEST_CASE("a trust document in bad form is refused with its place") {
    Site site;
    const auto form = [&](const std::function<void(TrustDocument&)>& change) {
        TrustDocument terms = site.trust_terms();
        change(terms);
        return read_trust(Site::sign_trust(terms, {&site.anna, &site.ben}));
    };
    const auto body = [&](const std::function<void(Json&)>& change) {
        Json json = trust_body(site.trust_terms());
        change(json);
        return read_trust(Site::sign(Purpose::trust_document, json, {&site.anna, &site.ben}));
    };
    check_refused(form([](auto& t) { t.keys[3].roles = {Role::release}; }), "has no stamp key");
    check_refused(form([](auto& t) { t.keys.pop_back(); }), "has no log key");
    check_refused(form([](auto& t) {
                      t.keys[3].roles = {Role::release, Role::stamp};
                  }),
                  "more than its one role");
    check_refused(form([](auto& t) {
                      t.keys[3].roles = {Role::stamp, Role::log};
                  }),
                  "more than its one role");
    check_refused(form([](auto& t) {
                      t.keys[0].roles = {Role::release, Role::root};
                  }),
                  "must be in the order");
    check_refused(form([](auto& t) { t.keys[0].roles = {}; }), "body.keys[0].roles: must be a list of roles");
    check_refused(form([](auto& t) { t.keys.push_back(t.keys[0]); }), "is a key that is listed already");
    check_refused(form([](auto& t) { t.release_threshold = 4; }),
                  "asks for more people than have a release key");
    check_refused(form([](auto& t) { t.root_threshold = 3; }), "asks for more people than have a root key");
    check_refused(form([](auto& t) { t.root_threshold = 0; }), "must be a whole number from 1");
    check_refused(form([](auto& t) { t.version = 0; }), "body.number");
    check_refused(form([](auto& t) { t.site = ""; }), "body.site: must be a name");
    check_refused(form([](auto& t) { t.keys[0].public_key = {}; }),
                  "body.keys[0].public: is not a sound public key");
    check_refused(body([](Json& j) { j["keys"][0]["id"] = std::string(64, '0'); }),
                  "is not the id of this public key");
    check_refused(body([](Json& j) { j["keys"][0]["roles"][0] = "boss"; }), "none of root, release, stamp");
    check_refused(body([](Json& j) { j["version"] = 2; }), "newer than this program");
    check_refused(body([](Json& j) { j["format"] = "weave-release"; }), "must be weave-trust");
    check_refused(body([](Json& j) { j["expires"] = 1; }), "is not known here");
    check_refused(body([](Json& j) { j["issued"] = "2026-02-30T00:00:00.000Z"; }), "is not a moment in UTC");
    check_refused(read_trust(std::string(most_trust_bytes + 1, ' ')), "is too large");
}

TEST_CASE("a flipped bit anywhere in a trust document that follows is refused") {
    const Site site;
    const TrustDocument first = site.trust();
    const std::string bytes = Site::sign_trust(site.trust_terms(2), {&site.anna, &site.ben});
    REQUIRE(next_trust(first, bytes));
    testing::for_all(
        [&](testing::Random& random) {
            std::string changed = bytes;
            const std::size_t at = random.between(0, bytes.size() - 1);
            changed[at] = static_cast<char>(changed[at] ^ (1 << random.between(0, 7)));
            REQUIRE_FALSE(next_trust(first, changed));
            REQUIRE_FALSE(next_trust(first, bytes.substr(0, at)));
        },
        testing::property_cases() / 10);
}
