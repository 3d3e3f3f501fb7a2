#include <weave/keys/signed_document.hpp>

#include <weave/core/json_reader.hpp>
#include <weave/core/sha256.hpp>
#include <weave/keys/members.hpp>

#include <algorithm>

namespace weave {

Signature sign_body(const KeyPair& pair, Purpose purpose, const Json& body) {
    return pair.sign(purpose, canonical_json(body));
}

bool verify_body(const PublicKey& key, Purpose purpose, const Json& body, const Signature& signature) {
    return verify(key, purpose, canonical_json(body), signature);
}

Json to_json(const SignedDocument& document) {
    auto signatures = document.signatures;
    std::sort(signatures.begin(), signatures.end(),
              [](const Signature& a, const Signature& b) { return a.key < b.key; });
    Json list = Json::array();
    for (const Signature& signature : signatures)
        list.push_back({{"key", signature.key}, {"value", signature.value}});
    return {{"body", document.body}, {"signatures", std::move(list)}};
}

std::string write_signed(const SignedDocument& document) {
    return canonical_json(to_json(document));
}

Result<SignedDocument> signed_from_json(const Json& json) {
    constexpr std::size_t key_characters = 64, value_characters = 128;
    JsonReader reader(json, "");
    SignedDocument document;
    document.body = reader.object("body").json();
    auto signatures = reader.objects("signatures");
    if (signatures.empty() || signatures.size() > most_signatures)
        reader.fail("must be a list of 1 to " + std::to_string(most_signatures) + " signatures",
                    "signatures");
    for (auto& entry : signatures) {
        if (reader.failed()) break;
        Signature signature{hex_member(entry, "key", key_characters),
                            hex_member(entry, "value", value_characters)};
        entry.no_others();
        if (!document.signatures.empty() && signature.key == document.signatures.back().key)
            entry.fail("is of a key that has signed already: a key counts once", "key");
        if (!document.signatures.empty() && signature.key < document.signatures.back().key)
            entry.fail("is out of order: signatures are sorted by key", "key");
        document.signatures.push_back(std::move(signature));
    }
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    return document;
}

Result<SignedDocument> read_signed(std::string_view bytes, std::size_t limit) {
    if (bytes.size() > limit)
        return bad_input("is too large: a document of this kind has at most " + std::to_string(limit) +
                         " bytes");
    WEAVE_TRY(const Json json, parse_json(bytes));
    if (canonical_json(json) != bytes)
        return bad_input(
            "is not in canonical form (RFC 8785), so that its bytes could mean more than was signed");
    return signed_from_json(json);
}

std::string body_sha256(const SignedDocument& document) {
    return sha256_hex(canonical_json(document.body));
}

}  // namespace weave
