#include <loomlink/keys/sealed_key.hpp>

#include <weave/keys/hex.hpp>
#include <weave/keys/members.hpp>
#include <weave/keys/sodium.hpp>

#include <sodium.h>

namespace weave::loomlink {

namespace {

constexpr const char* format = "weave-sealed-key";
constexpr std::size_t most_text = 8192;

static_assert(sizeof(SealedKey::nonce) == crypto_aead_xchacha20poly1305_ietf_NPUBBYTES);
static_assert(sizeof(SealedKey::sealed) == KeyPair::seed_bytes + crypto_aead_xchacha20poly1305_ietf_ABYTES);

/// All but the sealed secret, which it is bound to.
Json open_part(const SealedKey& key) {
    return {{"format", format},
            {"version", 1},
            {"key", key.id()},
            {"person", key.person},
            {"public", to_hex(key.public_key)},
            {"passes", key.cost.passes},
            {"memory", key.cost.memory_bytes},
            {"salt", to_hex(key.salt)},
            {"nonce", to_hex(key.nonce)}};
}

const unsigned char* raw(const std::string& bytes) {
    return reinterpret_cast<const unsigned char*>(bytes.data());
}

SealedKey seal(const std::string& person, const KeyPair& pair, std::string_view password, GuessCost cost) {
    SealedKey key{person, pair.public_key(), cost, {}, {}, {}};
    randombytes_buf(key.salt.data(), key.salt.size());
    randombytes_buf(key.nonce.data(), key.nonce.size());
    const SecretBytes seed = pair.seed(), lock = key_from_password(password, key.salt, cost);
    const std::string bound = canonical_json(open_part(key));
    crypto_aead_xchacha20poly1305_ietf_encrypt(key.sealed.data(), nullptr, seed.data(), seed.size(),
                                               raw(bound), bound.size(), nullptr, key.nonce.data(),
                                               lock.data());
    return key;
}

Error stays_shut() {
    return {ErrorCode::refused, "the password does not open this signing key", "password"};
}

Result<KeyPair> open(const SealedKey& key, std::string_view password) {
    if (!is_affordable(key.cost)) return stays_shut();
    const SecretBytes lock = key_from_password(password, key.salt, key.cost);
    const std::string bound = canonical_json(open_part(key));
    SecretBytes seed(KeyPair::seed_bytes);
    if (crypto_aead_xchacha20poly1305_ietf_decrypt(seed.data(), nullptr, nullptr, key.sealed.data(),
                                                   key.sealed.size(), raw(bound), bound.size(),
                                                   key.nonce.data(), lock.data()) != 0)
        return stays_shut();
    KeyPair pair = KeyPair::from_seed(seed);
    if (pair.public_key() != key.public_key) return stays_shut();
    return pair;
}

template <std::size_t N>
void read_hex(JsonReader& reader, const std::string& member, std::array<unsigned char, N>& bytes) {
    from_hex(hex_member(reader, member, 2 * N), bytes);
}

}  // namespace

SealedKey make_sealed_key(const std::string& person, std::string_view password, GuessCost cost) {
    return seal(person, KeyPair::generate(), password, cost);
}

Result<Signature> sign_with(const SealedKey& key, std::string_view password, Purpose purpose,
                            std::string_view message) {
    WEAVE_TRY(const KeyPair pair, open(key, password));
    return pair.sign(purpose, message);
}

Result<SealedKey> change_password(const SealedKey& key, std::string_view old_password,
                                  std::string_view new_password, GuessCost cost) {
    WEAVE_TRY(const KeyPair pair, open(key, old_password));
    return seal(key.person, pair, new_password, cost);
}

std::string write_sealed_key(const SealedKey& key) {
    Json json = open_part(key);
    json["sealed"] = to_hex(key.sealed);
    return canonical_json(json);
}

Result<SealedKey> read_sealed_key(std::string_view text) {
    if (text.size() > most_text) return bad_input("is too large for a sealed key");
    WEAVE_TRY(const Json json, parse_json(text));
    JsonReader reader(json, "");
    SealedKey key;
    read_heading(reader, format);
    key.person = name_member(reader, "person");
    const std::string id = hex_member(reader, "key", 64), public_key = reader.text("public", {}, 64);
    key.cost = {count_member(reader, "passes"), static_cast<std::size_t>(count_member(reader, "memory"))};
    read_hex(reader, "salt", key.salt);
    read_hex(reader, "nonce", key.nonce);
    read_hex(reader, "sealed", key.sealed);
    reader.no_others();
    if (!reader.failed() && !is_affordable(key.cost))
        reader.fail("is no cost that this program spends", "passes");
    WEAVE_CHECK_OK(reader.status());
    auto parsed = parse_public_key(public_key);
    if (!parsed) return std::move(parsed).error().under("public");
    key.public_key = *parsed;
    if (key.id() != id) return bad_input("is not the id of this public key", "key");
    return key;
}

}  // namespace weave::loomlink
