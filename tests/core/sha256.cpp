#include <weave/core/sha256.hpp>

#include <support/random.hpp>

using namespace weave;

TEST_CASE("SHA-256 gives the digests that NIST publishes") {
    // FIPS 180-4 example messages and the one of a million letters
    REQUIRE(sha256_hex("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    REQUIRE(sha256_hex("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    REQUIRE(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    REQUIRE(sha256_hex("abcdefghbcdefghicdefghijdefghijkefghijklfghijklmghijklmnhijklmnoijklmnopjklmnopqklmno"
                       "pqrlmnopqrsmnopqrstnopqrstu") ==
            "cf5b16a778af8380036ce59e7b0492370b249b11e8f07a51afac45037afee9d1");
    REQUIRE(sha256_hex(std::string(1000000, 'a')) ==
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("SHA-256 is the same in whatever pieces the bytes come") {
    weave::testing::for_all(
        [](weave::testing::Random& random) {
            std::string bytes(random.between(0, 300), '\0');
            for (char& byte : bytes) byte = static_cast<char>(random.between(0, 255));
            Sha256 hash;
            for (std::size_t at = 0; at < bytes.size();) {
                const std::size_t piece = random.between(0, 130);
                hash.add(std::string_view(bytes).substr(at, piece));
                at += piece;
            }
            REQUIRE(hash.hex() == sha256_hex(bytes));
        },
        weave::testing::property_cases());
}
