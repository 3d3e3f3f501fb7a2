#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace weave {

/// A SHA-256 as its 32 bytes.
using Hash = std::array<unsigned char, 32>;

/// SHA-256 of `bytes`, by OpenSSL, which is several times as fast as the core's own where the processor
/// helps.
Hash sha256(std::string_view bytes);

/// 64 lower-case hexadecimal characters.
std::string hash_hex(const Hash& hash);

/// The hash that exactly 64 lower-case hexadecimal characters say; nothing otherwise, so that a hash has one
/// text.
std::optional<Hash> parse_hash(std::string_view text);

}  // namespace weave
