#include <weave/keys/hash.hpp>

#include <weave/keys/hex.hpp>

#include <openssl/sha.h>

namespace weave {

Hash sha256(std::string_view bytes) {
    Hash hash{};
    ::SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), hash.data());
    return hash;
}

std::string hash_hex(const Hash& hash) {
    return to_hex(hash);
}

std::optional<Hash> parse_hash(std::string_view text) {
    return hex_array<std::tuple_size_v<Hash>>(text);
}

}  // namespace weave
