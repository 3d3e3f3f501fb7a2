#pragma once

#include <weave/keys/secret_bytes.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace weave::loomlink {

/// What one guess at a password costs (Argon2id, RFC 9106): passes over the memory, and the memory in bytes.
struct GuessCost {
    std::uint64_t passes = 0;
    std::size_t memory_bytes = 0;
    friend bool operator==(const GuessCost&, const GuessCost&) = default;
};

/// For the keys of people: 3 passes over 256 MiB (libsodium's MODERATE).
GuessCost key_cost();
/// For logging in, which happens more often: 2 passes over 64 MiB (libsodium's INTERACTIVE).
GuessCost login_cost();
/// The least that the algorithm takes, for tests alone: 1 pass over 8 KiB.
GuessCost test_cost();

/// Whether a cost from outside is one that this program will spend: at most 16 passes over at most 1 GiB.
bool is_affordable(GuessCost cost);

inline constexpr std::size_t argon_salt_bytes = 16;

/// A key of 32 bytes from a password and a salt of `argon_salt_bytes`. No more than two such computations run
/// at once in a process, so that many log-ins at a time take long and not all memory. Throws std::bad_alloc
/// without memory.
SecretBytes key_from_password(std::string_view password, std::span<const unsigned char> salt, GuessCost cost);

/// Holds one of the two places for as long as it lives.
class ArgonPlace {
  public:
    ArgonPlace();
    ~ArgonPlace();
    ArgonPlace(const ArgonPlace&) = delete;
    ArgonPlace& operator=(const ArgonPlace&) = delete;
};

}  // namespace weave::loomlink
