#pragma once

#include <weave/core/sha256.hpp>

#include <catch2/catch.hpp>

#include <loomlink/keys/release_index.hpp>
#include <loomlink/keys/release_manifest.hpp>
#include <loomlink/terminal/check.hpp>
#include <string>
#include <support/refusals.hpp>
#include <vector>

namespace weave::testing {

/// A mill with its people's and its server's keys, which signs whatever a test wants, true or not.
struct Site {
    static constexpr const char* name = "mill";
    static constexpr const char* loom = "loom 7";
    KeyPair anna = KeyPair::generate(), ben = KeyPair::generate(),
                      carl = KeyPair::generate(), thief = KeyPair::generate(),
                      stamp = KeyPair::generate(), log = KeyPair::generate();

    /// 2026-11-26T08:00 and some minutes.
    static Instant at(int minutes) {
        return parse_utc("2026-11-26T08:00:00.000Z").value() + std::chrono::minutes(minutes);
    }

    /// Anna and Ben are roots, both have to sign; Anna, Ben and Carl release, two of them; one stamp and one
    /// log key.
    [[nodiscard]] loomlink::TrustDocument trust_terms(std::uint64_t version = 1) const {
        using loomlink::Role;
        loomlink::TrustDocument trust;
        trust.version = version;
        trust.site = name;
        trust.issued = at(0);
        trust.keys = {{anna.public_key(), "anna", {Role::root, Role::release}},
                      {ben.public_key(), "ben", {Role::root, Role::release}},
                      {carl.public_key(), "carl", {Role::release}},
                      {stamp.public_key(), "loomlink", {Role::stamp}},
                      {log.public_key(), "loomlink", {Role::log}}};
        trust.root_threshold = 2;
        trust.release_threshold = 2;
        return trust;
    }

    static std::string sign(Purpose purpose, const Json& body,
                            const std::vector<const KeyPair*>& keys) {
        SignedDocument document{body, {}};
        for (const auto* key : keys) document.signatures.push_back(sign_body(*key, purpose, body));
        return write_signed(document);
    }
    static std::string sign_trust(const loomlink::TrustDocument& trust,
                                  const std::vector<const KeyPair*>& keys) {
        return sign(Purpose::trust_document, trust_body(trust), keys);
    }
    [[nodiscard]] std::string trust_bytes() const { return sign_trust(trust_terms(), {&anna, &ben}); }
    [[nodiscard]] loomlink::TrustDocument trust() const {
        return loomlink::read_trust(trust_bytes()).value();
    }
    [[nodiscard]] loomlink::TerminalState terminal() const {
        return loomlink::first_state(loom, trust_bytes(), trust().fingerprint()).value();
    }

    /// The honest log has one root a size.
    static std::string root_of(std::uint64_t size) { return sha256_hex("log of " + std::to_string(size)); }
    [[nodiscard]] loomlink::SignedLogHead head(std::uint64_t size, const KeyPair& key) const {
        return loomlink::sign_head(key, {name, size, root_of(size), at(0)});
    }
    static Status consistent(const loomlink::LogHead& older, const loomlink::LogHead& newer) {
        if (older.root == root_of(older.size) && newer.root == root_of(newer.size)) return {};
        return bad_input("the proof does not fit");
    }

    /// Two files of a release, and the manifest that two people signed.
    static std::vector<loomlink::PulledFile> files(std::uint64_t number) {
        return {{"shoe.jc5", "card of release " + std::to_string(number) + std::string(1, '\0')},
                {"shoe-picks.csv", "pick,feeder\n1," + std::to_string(number) + "\n"}};
    }
    static std::string revision(std::uint64_t number) {
        return sha256_hex("revision " + std::to_string(number));
    }
    static loomlink::ReleaseManifest manifest_terms(std::uint64_t number) {
        loomlink::ReleaseManifest manifest;
        manifest.site = name;
        manifest.loom = loom;
        manifest.release = number;
        manifest.released = at(0);
        manifest.design = "shoe";
        manifest.revision = number;
        manifest.revision_sha256 = revision(number);
        manifest.design_sha256 = sha256_hex("design");
        manifest.scene_sha256 = sha256_hex("scene");
        manifest.card_sha256 = sha256_hex("card");
        manifest.profile_name = "JC5 5120";
        manifest.profile_revision = "3";
        manifest.profile_sha256 = sha256_hex("profile");
        manifest.profile_version = 2;
        manifest.picks = 4;
        manifest.ends = 8;
        manifest.reading = {{"lifted_bit", 1}};
        manifest.feeders = Json::array({{{"design", 1}, {"loom", 3}}});
        for (const auto& file : files(number))
            manifest.files.push_back({file.path, file.bytes.size(), sha256_hex(file.bytes), "jc5", false,
                                      "layout-compatible with observed files, not certified by the maker"});
        return manifest;
    }
    static std::string sign_manifest(const loomlink::ReleaseManifest& manifest,
                                     const std::vector<const KeyPair*>& keys) {
        return sign(Purpose::release_manifest, manifest_body(manifest), keys);
    }
    [[nodiscard]] std::string manifest(std::uint64_t number) const {
        return sign_manifest(manifest_terms(number), {&anna, &carl});
    }

    /// An index of releases 1 … `releases`, issued at `minutes` for an hour.
    [[nodiscard]] loomlink::ReleaseIndex index_terms(std::uint64_t epoch, std::uint64_t releases,
                                                     int minutes) const {
        loomlink::ReleaseIndex index;
        index.site = name;
        index.loom = loom;
        index.epoch = epoch;
        index.issued = at(minutes);
        index.expires = at(minutes + 60);
        index.tree_head = head(epoch + 2, log);
        for (std::uint64_t number = 1; number <= releases; ++number)
            index.releases.push_back(
                {number, revision(number), sha256_hex(manifest(number)), loomlink::ReleaseState::released});
        return index;
    }
    [[nodiscard]] std::string sign_index(const loomlink::ReleaseIndex& index) const {
        return sign(Purpose::release_index, index_body(index), {&stamp});
    }
    [[nodiscard]] std::string index(std::uint64_t epoch, std::uint64_t releases, int minutes) const {
        return sign_index(index_terms(epoch, releases, minutes));
    }
};

/// A finding: bytes that are not what was signed, which a program tells by its exit status from what was
/// signed and may not be used.
template <class Outcome>
void check_forged(const Outcome& outcome, const std::string& words) {
    check_refused(outcome, words);
    CHECK(outcome.error().code == ErrorCode::invalid);
}
/// Signed as it should be, and yet not to be used.
template <class Outcome>
void check_forbidden(const Outcome& outcome, const std::string& words) {
    check_refused(outcome, words);
    CHECK(outcome.error().code == ErrorCode::refused);
}

}  // namespace weave::testing
