#include <weave/keys/hex.hpp>
#include <weave/keys/key.hpp>

#include <catch2/catch.hpp>

#include <set>
#include <sodium.h>
#include <support/random.hpp>

using namespace weave;

namespace {

constexpr Purpose purposes[] = {Purpose::statement,      Purpose::tree_head, Purpose::release_manifest, Purpose::release_index,
                                Purpose::trust_document, Purpose::evidence,  Purpose::access_token};

/// The eight points of small order and the ways to write them beyond the field's prime, which lax readers
/// take.
const std::vector<std::string> small_order = {
    "0100000000000000000000000000000000000000000000000000000000000000",
    "0000000000000000000000000000000000000000000000000000000000000000",
    "0000000000000000000000000000000000000000000000000000000000000080",
    "ecffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff7f",
    "26e8958fc2b227b045c3f489f2ef98f0d5dfac05d3c63339b13802886d53fc05",
    "26e8958fc2b227b045c3f489f2ef98f0d5dfac05d3c63339b13802886d53fc85",
    "c7176a703d4dd84fba3c0b760d10670f2a2053fa2c39ccc64ec7fd7792ac037a",
    "c7176a703d4dd84fba3c0b760d10670f2a2053fa2c39ccc64ec7fd7792ac03fa",
    "0100000000000000000000000000000000000000000000000000000000000080",
    "edffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff7f",
    "eeffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff7f",
    "edffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff",
    "eeffffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff"};

/// S + L for the second half of a signature: the same equation, another text.
std::string with_s_plus_order(const std::string& value) {
    auto bytes = hex_array<64>(value).value();
    const auto order =
        hex_array<32>("edd3f55c1a631258d69cf7a2def9de1400000000000000000000000000000010").value();
    unsigned carry = 0;
    for (std::size_t k = 0; k < order.size(); ++k) {
        carry += static_cast<unsigned>(bytes[32 + k]) + order[k];
        bytes[32 + k] = static_cast<unsigned char>(carry & 255);
        carry >>= 8;
    }
    return to_hex(bytes);
}

}  // namespace

TEST_CASE("a key pair is that of RFC 8032, and comes from its seed again") {
    SecretBytes seed(KeyPair::seed_bytes);
    REQUIRE(from_hex("9d61b19deffd5a60ba844af492ec2cc44449c5697b326919703bac031cae7f60",
                     {seed.data(), seed.size()}));
    const KeyPair pair = KeyPair::from_seed(seed);
    CHECK(to_hex(pair.public_key()) == "d75a980182b10ab7d54bfed3c964073a0ee172f3daa62325af021a68f707511a");
    CHECK(pair.id() == "21fe31dfa154a261626bf854046fd2271b7bed4b6abe45aa58877ef47f9721b9");
    CHECK(KeyPair::from_seed(pair.seed()).public_key() == pair.public_key());
    CHECK(KeyPair::generate().id() != KeyPair::generate().id());
}

TEST_CASE("a signature counts for its purpose alone") {
    const KeyPair pair = KeyPair::generate();
    std::set<std::string> domains;
    for (const Purpose made : purposes) {
        const Signature signature = pair.sign(made, "message");
        for (const Purpose shown : purposes)
            CHECK(verify(pair.public_key(), shown, "message", signature) == (made == shown));
        domains.insert(signing_bytes(made, ""));
    }
    CHECK(domains.size() == std::size(purposes));
    CHECK(signing_bytes(Purpose::statement, "{}") == "weave statement v1\n{}");
    for (const std::string& one : domains)
        for (const std::string& other : domains) CHECK((one == other || !one.starts_with(other)));
}

TEST_CASE("a signature without a domain, over the whole text by hand, is none for the message") {
    const KeyPair pair = KeyPair::generate();
    const Signature nested = pair.sign(Purpose::evidence, signing_bytes(Purpose::release_manifest, "m"));
    CHECK_FALSE(verify(pair.public_key(), Purpose::release_manifest, "m", nested));
}

TEST_CASE("one flipped bit anywhere breaks a signature") {
    const KeyPair pair = KeyPair::generate();
    const std::string message = "a message of some length";
    const Signature signature = pair.sign(Purpose::statement, message);
    REQUIRE(verify(pair.public_key(), Purpose::statement, message, signature));
    for (std::size_t bit = 0; bit < 8 * message.size(); ++bit) {
        std::string changed = message;
        changed[bit / 8] = static_cast<char>(changed[bit / 8] ^ (1 << bit % 8));
        CHECK_FALSE(verify(pair.public_key(), Purpose::statement, changed, signature));
    }
    const auto value = hex_array<64>(signature.value).value();
    for (std::size_t bit = 0; bit < 8 * value.size(); ++bit) {
        auto changed = value;
        changed[bit / 8] = static_cast<unsigned char>(changed[bit / 8] ^ (1 << bit % 8));
        CHECK_FALSE(verify(pair.public_key(), Purpose::statement, message, {signature.key, to_hex(changed)}));
    }
    for (std::size_t bit = 0; bit < 256; ++bit) {
        PublicKey key = pair.public_key();
        key[bit / 8] = static_cast<unsigned char>(key[bit / 8] ^ (1 << bit % 8));
        CHECK_FALSE(verify(key, Purpose::statement, message, {key_id(key), signature.value}));
    }
}

TEST_CASE(
    "a signature has one text: cut, lengthened, capital, of another key's name or with S + L it is none") {
    const KeyPair pair = KeyPair::generate(), other = KeyPair::generate();
    const Signature good = pair.sign(Purpose::statement, "m");
    const auto counts = [&](const std::string& key, const std::string& value) {
        return verify(pair.public_key(), Purpose::statement, "m", {key, value});
    };
    REQUIRE(counts(good.key, good.value));
    CHECK_FALSE(counts(good.key, good.value.substr(0, 126)));
    CHECK_FALSE(counts(good.key, good.value + "00"));
    CHECK_FALSE(counts(good.key, ""));
    std::string capital = good.value;
    for (char& c : capital) c = static_cast<char>(std::toupper(c));
    REQUIRE(capital != good.value);
    CHECK_FALSE(counts(good.key, capital));
    CHECK_FALSE(counts(other.id(), good.value));
    CHECK_FALSE(counts("", good.value));
    CHECK_FALSE(counts(good.key, with_s_plus_order(good.value)));
    CHECK_FALSE(verify(pair.public_key(), Purpose::statement, "mm", good));
}

TEST_CASE("points of small order are no public keys, and nothing counts as their signature") {
    for (const std::string& hex : small_order) {
        INFO(hex);
        CHECK_FALSE(parse_public_key(hex));
        const PublicKey key = hex_array<32>(hex).value();
        for (const std::string& r :
             small_order)  // R of small order and S = 0 solve the equation for many messages
            CHECK_FALSE(verify(key, Purpose::statement, "m", {key_id(key), r + std::string(64, '0')}));
    }
    const KeyPair pair = KeyPair::generate();
    CHECK(parse_public_key(to_hex(pair.public_key())).value() == pair.public_key());
    PublicKey mixed{};
    const auto torsion = hex_array<32>(small_order[4]).value();
    REQUIRE(crypto_core_ed25519_add(mixed.data(), pair.public_key().data(), torsion.data()) == 0);
    CHECK_FALSE(parse_public_key(to_hex(mixed)));  // on the curve, outside the group
    CHECK_FALSE(parse_public_key(std::string(64, 'x')));
    CHECK_FALSE(parse_public_key(to_hex(pair.public_key()).substr(2)));
}

TEST_CASE("random bytes are no signature") {
    const KeyPair pair = KeyPair::generate();
    testing::for_all(
        [&](testing::Random& random) {
            std::array<unsigned char, 64> value{};
            for (auto& byte : value) byte = static_cast<unsigned char>(random.between(0, 255));
            REQUIRE_FALSE(verify(pair.public_key(), Purpose::statement, "m", {pair.id(), to_hex(value)}));
        },
        testing::property_cases() / 10);
}
