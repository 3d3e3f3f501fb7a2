#include "signed.hpp"

#include "must.hpp"

#include <cstring>

namespace weave::fuzz {

using namespace loomlink;

const KeyPair& one_key(Role role) {
    const auto made = [](unsigned char first) {
        SecretBytes seed(KeyPair::seed_bytes);
        std::memset(seed.data(), first, seed.size());
        return KeyPair::from_seed(seed);
    };
    static const KeyPair person = made(1), stamp = made(2), log = made(3);
    return role == Role::stamp ? stamp : role == Role::log ? log : person;
}

const TrustDocument& one_site() {
    static const TrustDocument site = [] {
        TrustDocument trust;
        trust.site = "mill";
        trust.issued = parse_utc("2026-11-26T08:00:00.000Z").value();
        trust.keys = {{one_key(Role::root).public_key(), "anna", {Role::root, Role::release}},
                      {one_key(Role::stamp).public_key(), "loomlink", {Role::stamp}},
                      {one_key(Role::log).public_key(), "loomlink", {Role::log}}};
        const Json body = trust_body(trust);
        const auto read =
            read_trust(write_signed({body, {sign_body(one_key(Role::root), Purpose::trust_document, body)}}));
        must(static_cast<bool>(read), "the site to begin with is sound");
        return *read;
    }();
    return site;
}

std::string signed_by_site(std::string_view body, Purpose purpose, Role role) {
    const auto json = parse_json(body);
    if (!json || !json->is_object()) return {};
    return write_signed({*json, {sign_body(one_key(role), purpose, *json)}});
}

}  // namespace weave::fuzz
