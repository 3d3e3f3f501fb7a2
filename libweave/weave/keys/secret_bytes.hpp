#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace weave {

/// Bytes that nobody else may see: kept out of swap and core dumps where the system allows it, between guard
/// pages, and wiped when they go. Zero at first. Throws std::bad_alloc where there is no memory.
class SecretBytes {
  public:
    explicit SecretBytes(std::size_t size);
    ~SecretBytes();
    SecretBytes(SecretBytes&& other) noexcept;
    SecretBytes& operator=(SecretBytes&& other) noexcept;
    SecretBytes(const SecretBytes&) = delete;
    SecretBytes& operator=(const SecretBytes&) = delete;

    [[nodiscard]] unsigned char* data() { return m_data; }
    [[nodiscard]] const unsigned char* data() const { return m_data; }
    [[nodiscard]] std::size_t size() const { return m_size; }

  private:
    unsigned char* m_data;
    std::size_t m_size;
};

/// Overwrites a text that held a secret, such as a password that a request brought, and empties it.
void wipe(std::string& secret);

/// Whether two secrets are equal, in a time that does not tell where they differ (their lengths are no
/// secret).
bool equal_secrets(std::string_view one, std::string_view other);

}  // namespace weave
