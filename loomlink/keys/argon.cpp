#include <loomlink/keys/argon.hpp>

#include <weave/keys/sodium.hpp>

#include <cassert>
#include <new>
#include <semaphore>
#include <sodium.h>

namespace weave::loomlink {

namespace {

constexpr std::size_t sealing_key_bytes = 32;
constexpr std::uint64_t most_passes = 16;
constexpr std::size_t most_memory = std::size_t{1} << 30;

static_assert(argon_salt_bytes == crypto_pwhash_SALTBYTES);

std::counting_semaphore<2>& places() {
    static std::counting_semaphore<2> free_places(2);
    return free_places;
}

}  // namespace

GuessCost key_cost() {
    return {crypto_pwhash_OPSLIMIT_MODERATE, crypto_pwhash_MEMLIMIT_MODERATE};
}

GuessCost login_cost() {
    return {crypto_pwhash_OPSLIMIT_INTERACTIVE, crypto_pwhash_MEMLIMIT_INTERACTIVE};
}

GuessCost test_cost() {
    return {crypto_pwhash_OPSLIMIT_MIN, crypto_pwhash_MEMLIMIT_MIN};
}

bool is_affordable(GuessCost cost) {
    return cost.passes >= crypto_pwhash_OPSLIMIT_MIN && cost.passes <= most_passes &&
           cost.memory_bytes >= crypto_pwhash_MEMLIMIT_MIN && cost.memory_bytes <= most_memory;
}

ArgonPlace::ArgonPlace() {
    places().acquire();
}

ArgonPlace::~ArgonPlace() {
    places().release();
}

SecretBytes key_from_password(std::string_view password, std::span<const unsigned char> salt,
                              GuessCost cost) {
    need_sodium();
    assert(salt.size() == argon_salt_bytes && is_affordable(cost));
    SecretBytes key(sealing_key_bytes);
    const ArgonPlace place;
    if (crypto_pwhash(key.data(), key.size(), password.data(), password.size(), salt.data(), cost.passes,
                      cost.memory_bytes, crypto_pwhash_ALG_ARGON2ID13) != 0)
        throw std::bad_alloc();  // the one way for it to fail with such arguments
    return key;
}

}  // namespace weave::loomlink
