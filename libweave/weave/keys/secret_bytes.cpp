#include <weave/keys/secret_bytes.hpp>

#include <weave/keys/sodium.hpp>

#include <new>
#include <sodium.h>
#include <utility>

namespace weave {

namespace {

unsigned char* guarded(std::size_t size) {
    need_sodium();
    void* const memory = sodium_malloc(size);  // locked and guarded; freed memory is wiped
    if (memory == nullptr) throw std::bad_alloc();
    sodium_memzero(memory, size);
    return static_cast<unsigned char*>(memory);
}

}  // namespace

SecretBytes::SecretBytes(std::size_t size) : m_data(guarded(size)), m_size(size) {}

SecretBytes::~SecretBytes() {
    sodium_free(m_data);
}

SecretBytes::SecretBytes(SecretBytes&& other) noexcept
    : m_data(std::exchange(other.m_data, nullptr)), m_size(std::exchange(other.m_size, 0)) {}

SecretBytes& SecretBytes::operator=(SecretBytes&& other) noexcept {
    std::swap(m_data, other.m_data);
    std::swap(m_size, other.m_size);
    return *this;
}

void wipe(std::string& secret) {
    sodium_memzero(secret.data(), secret.size());
    secret.clear();
}

bool equal_secrets(std::string_view one, std::string_view other) {
    need_sodium();
    return one.size() == other.size() && sodium_memcmp(one.data(), other.data(), one.size()) == 0;
}

}  // namespace weave
