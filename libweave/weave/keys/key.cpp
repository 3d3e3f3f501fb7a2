#include <weave/keys/key.hpp>

#include <weave/core/sha256.hpp>
#include <weave/keys/hex.hpp>
#include <weave/keys/sodium.hpp>

#include <sodium.h>

namespace weave {

namespace {

static_assert(std::tuple_size_v<PublicKey> == crypto_sign_PUBLICKEYBYTES);
static_assert(KeyPair::seed_bytes == crypto_sign_SEEDBYTES);

std::string_view domain_of(Purpose purpose) {
    switch (purpose) {
        case Purpose::statement:
            return "weave statement v1\n";
        case Purpose::tree_head:
            return "weave tree head v1\n";
        case Purpose::release_manifest:
            return "weave release manifest v1\n";
        case Purpose::release_index:
            return "weave release index v1\n";
        case Purpose::trust_document:
            return "weave trust document v1\n";
        case Purpose::evidence:
            return "weave evidence v1\n";
        case Purpose::access_token:
            return "weave access token v1\n";
    }
    return {};
}

const unsigned char* raw(const std::string& bytes) {
    return reinterpret_cast<const unsigned char*>(bytes.data());
}

}  // namespace

std::string signing_bytes(Purpose purpose, std::string_view message) {
    return std::string(domain_of(purpose)).append(message);
}

std::string key_id(const PublicKey& key) {
    return sha256_hex({reinterpret_cast<const char*>(key.data()), key.size()});
}

Result<PublicKey> parse_public_key(std::string_view hex) {
    need_sodium();
    const auto key = hex_array<crypto_sign_PUBLICKEYBYTES>(hex);
    if (!key) return bad_input("must be a public key of 64 lower-case hexadecimal characters");
    if (crypto_core_ed25519_is_valid_point(key->data()) != 1)
        return bad_input("is not a sound public key: it is no point of the group that signatures need");
    return *key;
}

bool verify(const PublicKey& key, Purpose purpose, std::string_view message, const Signature& signature) {
    need_sodium();
    const auto value = hex_array<crypto_sign_BYTES>(signature.value);
    if (!value || signature.key != key_id(key)) return false;
    if (crypto_core_ed25519_is_valid_point(key.data()) != 1) return false;
    const std::string bytes = signing_bytes(purpose, message);
    return crypto_sign_verify_detached(value->data(), raw(bytes), bytes.size(), key.data()) == 0;
}

KeyPair::KeyPair(const SecretBytes& seed) : m_secret(crypto_sign_SECRETKEYBYTES) {
    assert(seed.size() == seed_bytes);
    crypto_sign_seed_keypair(m_public.data(), m_secret.data(), seed.data());
    m_id = key_id(m_public);
}

KeyPair KeyPair::generate() {
    SecretBytes seed(seed_bytes);
    randombytes_buf(seed.data(), seed.size());
    return KeyPair(seed);
}

KeyPair KeyPair::from_seed(const SecretBytes& seed) {
    return KeyPair(seed);
}

SecretBytes KeyPair::seed() const {
    SecretBytes seed(seed_bytes);
    crypto_sign_ed25519_sk_to_seed(seed.data(), m_secret.data());
    return seed;
}

Signature KeyPair::sign(Purpose purpose, std::string_view message) const {
    const std::string bytes = signing_bytes(purpose, message);
    std::array<unsigned char, crypto_sign_BYTES> value{};
    crypto_sign_detached(value.data(), nullptr, raw(bytes), bytes.size(), m_secret.data());
    return {m_id, to_hex(value)};
}

}  // namespace weave
