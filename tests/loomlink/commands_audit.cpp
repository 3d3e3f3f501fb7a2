// Evidence in a log that is verified offline: whose machine signed it, and whether the trust document names it.

#include "commands_case.hpp"
#include "site.hpp"

#include <weave/keys/hex.hpp>
#include <weave/keys/key.hpp>

#include <functional>
#include <loomlink/audit/bundle.hpp>
#include <loomlink/audit/tree.hpp>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;
using weave::testing::Site;

namespace {

const std::string moment = "2026-11-26T08:00:00.000Z";

/// A log that enrols the machine `box` and takes a piece of evidence from it.
struct EvidenceLog {
    KeyPair log = KeyPair::generate(), box = KeyPair::generate();
    Statement enrolled{"mill", "signer.enrolled", moment, "box", "box", {}, "r0", Json::object()};
    Statement evidence{"mill", "evidence.added", moment, "box", "shoe", {}, "r1", Json::object()};

    EvidenceLog() {
        const Json found{{"residual", 1e-4}};
        const Signature made = box.sign(Purpose::evidence, canonical_json(found));
        enrolled.data = {{"key", box.id()}, {"public_key", to_hex(box.public_key())}};
        evidence.data = {{"revision", 1}, {"statement", found}, {"key", made.key}, {"signature", made.value}};
    }

    /// The bundle, as a server with the key of the log signs it whatever stands in it.
    [[nodiscard]] std::string bundle() const {
        AuditBundle made;
        Hash prev{};
        for (const Statement& statement : {enrolled, evidence}) {
            made.records.push_back(record_bytes({made.records.size(), prev, statement, {}}).value());
            made.leaves.push_back(prev = leaf_hash(made.records.back()));
        }
        made.head.head = {"mill", made.leaves.size(), root_of(made.leaves), moment};
        const Signature signature = log.sign(Purpose::tree_head, head_bytes(made.head.head));
        made.head.signature = {signature.key, signature.value};
        return write_bundle(made);
    }

    /// A trust document of this log that lists the machine's key as this person's or machine's.
    [[nodiscard]] std::string trust_naming(const std::string& holder, Role role) const {
        const Site site;
        TrustDocument trust = site.trust_terms();
        trust.keys.push_back({log.public_key(), "loomlink", {Role::log}});
        trust.keys.push_back({box.public_key(), holder, {role}});
        return Site::sign_trust(trust, {&site.anna, &site.ben});
    }
};

struct Auditor {
    weave::testing::TemporaryFolder folder;

    [[nodiscard]] Ended verify(const std::string& bundle, const std::vector<std::string>& by) const {
        REQUIRE(write_file(folder.path / "log.json", bundle));
        std::vector<std::string> words{"audit", "verify", folder.path / "log.json", "--json"};
        words.insert(words.end(), by.begin(), by.end());
        return Running(words, folder.path).wait();
    }
    [[nodiscard]] Ended verify_by(const std::string& bundle, const std::string& trust) const {
        REQUIRE(write_file(folder.path / "trust.json", trust));
        return verify(bundle, {"--trust", folder.path / "trust.json", "--fingerprint", read_trust(trust).value().fingerprint()});
    }
};

}  // namespace

TEST_CASE("evidence that the machine it names has not signed is found in the log and its record named", "[commands]") {
    const Auditor auditor;
    const EvidenceLog honest;
    const std::string key = to_hex(honest.log.public_key());
    CHECK(auditor.verify(honest.bundle(), {"--key", key}).code == 0);
    const std::vector<std::pair<std::string, std::function<void(EvidenceLog&)>>> lies{
        {"another result", [](EvidenceLog& told) { told.evidence.data["statement"]["residual"] = 1e-5; }},
        {"another machine", [](EvidenceLog& told) { told.evidence.actor = "gpu"; }},
        {"a key that nobody enrolled", [](EvidenceLog& told) { told.evidence.data["key"] = KeyPair::generate().id(); }},
        {"no signature", [](EvidenceLog& told) { told.evidence.data.erase("signature"); }},
        {"a signature that is no text", [](EvidenceLog& told) { told.evidence.data["signature"] = 7; }},
        {"no result", [](EvidenceLog& told) { told.evidence.data.erase("statement"); }}};
    for (const auto& [name, lie] : lies) {
        EvidenceLog told;
        lie(told);
        const Ended ended = auditor.verify(told.bundle(), {"--key", to_hex(told.log.public_key())});
        INFO(name << ": " << ended.out << ended.err);
        CHECK(ended.code == 1);
        const Json found = ended.json().at("findings");
        REQUIRE(found.size() == 1);
        CHECK(found.at(0).at("seq") == 1);
        CHECK_THAT(found.at(0).dump(), Catch::Contains("its evidence is not signed by the machine that it names"));
    }
}

TEST_CASE("a machine that the trust document does not name is told and one that it names otherwise is found", "[commands]") {
    const Auditor auditor;
    const EvidenceLog told;
    const auto of = [&](const std::string& holder, Role role) {
        return auditor.verify_by(told.bundle(), told.trust_naming(holder, role));
    };
    const Ended named = of("box", Role::evidence);
    INFO(named.out << named.err);
    CHECK(named.code == 0);
    CHECK(named.json().at("machines_not_in_trust") == Json::array());
    CHECK(of("gpu", Role::evidence).code == 1);
    CHECK(of("box", Role::release).code == 1);
}
