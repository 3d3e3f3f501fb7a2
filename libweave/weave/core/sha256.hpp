#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace weave {

/// SHA-256 (FIPS 180-4) of bytes given piece by piece. Own code, because the core may need headers alone and
/// no packaged header offers it.
class Sha256 {
  public:
    void add(std::string_view bytes);

    /// The digest in lower-case hexadecimal, 64 characters. The object must not be used afterwards.
    [[nodiscard]] std::string hex();

  private:
    void digest_chunk(const unsigned char* chunk);

    std::array<std::uint32_t, 8> m_state{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                         0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    std::array<unsigned char, 64> m_rest{};
    std::uint64_t m_length = 0;
};

/// SHA-256 of `bytes` as 64 lower-case hexadecimal characters.
std::string sha256_hex(std::string_view bytes);

}  // namespace weave
