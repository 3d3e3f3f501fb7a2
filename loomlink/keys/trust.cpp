#include <loomlink/keys/trust.hpp>

#include <weave/core/text.hpp>

#include <algorithm>
#include <loomlink/keys/trust_form.hpp>
#include <set>

namespace weave::loomlink {

namespace {

/// How an error names a key.
std::string short_id(const std::string& id) {
    return id.substr(0, 16);
}

Error refused(std::string why, std::string where = {}) {
    return {ErrorCode::refused, std::move(why), std::move(where)};
}

Error too_few(const std::string& what, std::size_t needed, std::size_t have) {
    return refused(what + " must be signed by " + std::to_string(needed) +
                   (needed == 1 ? " person, and by " : " different people, and by ") + std::to_string(have) +
                   (have == 1 ? " is" : " are"));
}

/// Different people among the keys of a role that have signed; an error where one of their signatures does
/// not fit.
Result<std::size_t> people_who_signed(const SignedDocument& document, const TrustDocument& trust, Role role) {
    std::set<std::string> people;
    for (const Signature& signature : document.signatures) {
        const TrustedKey* key = trust.find(signature.key);
        if (key == nullptr || !key->has(role)) continue;
        if (!verify_body(key->public_key, Purpose::trust_document, document.body, signature))
            return refused("the signature of key " + short_id(signature.key) + " of " + key->person +
                           " does not fit: forged or altered");
        people.insert(key->person);
    }
    return people.size();
}

Status check_roots(const SignedDocument& document, const TrustDocument& judge, const std::string& what) {
    WEAVE_TRY(const std::size_t people, people_who_signed(document, judge, Role::root));
    if (people < judge.root_threshold) return too_few(what, judge.root_threshold, people);
    return {};
}

bool is_root(const TrustDocument& trust, const std::string& id) {
    const TrustedKey* key = trust.find(id);
    return key != nullptr && key->has(Role::root);
}

}  // namespace

const TrustedKey* TrustDocument::find(std::string_view id) const {
    const auto found =
        std::find_if(keys.begin(), keys.end(), [&](const TrustedKey& key) { return key.id() == id; });
    return found == keys.end() ? nullptr : &*found;
}

Result<TrustDocument> next_trust(const TrustDocument& now, std::string_view bytes) {
    WEAVE_TRY(TrustDocument next, read_trust(bytes));
    const std::string name = "trust document " + std::to_string(next.version);
    if (next.site != now.site)
        return refused(name + " is of the site '" + next.site + "', not of '" + now.site + "'");
    if (next.version != now.version + 1)
        return refused(name + " does not follow version " + std::to_string(now.version) +
                       ", which is trusted: versions come one after another and never go back");
    for (const Signature& signature : next.document.signatures) {
        if (!is_root(now, signature.key) && !is_root(next, signature.key))
            return refused(name + " is signed with key " + short_id(signature.key) + ", which is no root");
    }
    const std::string before = std::to_string(now.version);
    WEAVE_CHECK_OK(check_roots(next.document, now, name + ", by the rule of version " + before + ","));
    return next;
}

Result<TrustDocument> follow_trust(TrustDocument pinned, std::span<const std::string> documents) {
    for (std::size_t k = 0; k < documents.size(); ++k) {
        auto next = next_trust(pinned, documents[k]);
        if (!next) return std::move(next).error().under(indexed("documents", k));
        pinned = std::move(*next);
    }
    return pinned;
}

Status check_signatures(const SignedDocument& document, Purpose purpose, const TrustDocument& trust,
                        Role role, std::size_t people) {
    std::set<std::string> keys, signers;
    for (const Signature& signature : document.signatures) {
        const std::string name = "key " + short_id(signature.key);
        const TrustedKey* key = trust.find(signature.key);
        if (key == nullptr)
            return refused("is signed with " + name + ", which trust document " +
                           std::to_string(trust.version) + " does not know: unknown or revoked");
        if (!key->has(role))
            return refused("is signed with " + name + " of " + key->person +
                           ", which does not have the role " + name_of(role));
        if (!keys.insert(signature.key).second)
            return refused("is signed twice with " + name + ": a key counts once");
        if (!verify_body(key->public_key, purpose, document.body, signature))
            return refused("the signature of " + name + " of " + key->person +
                           " does not fit: forged or altered");
        signers.insert(key->person);
    }
    if (signers.size() < people) return too_few("this", people, signers.size());
    return {};
}

Result<TrustDocument> read_trust(std::string_view bytes) {
    WEAVE_TRY(TrustDocument trust, read_trust_form(bytes));
    WEAVE_CHECK_OK(check_roots(trust.document, trust, "trust document " + std::to_string(trust.version)));
    return trust;
}

}  // namespace weave::loomlink
