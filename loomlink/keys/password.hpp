#pragma once

#include <weave/core/result.hpp>

#include <loomlink/keys/argon.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace weave::loomlink {

/// Whether a password may be taken: UTF-8 without control characters, 12 characters or more and at most 1,024
/// bytes, not the login or the full name (whatever their case), and not one character over and over. The
/// error is a sentence for the person and does not hold the password. The bytes count as they are typed;
/// nothing is normalised.
Status check_password(std::string_view password, std::string_view login, std::string_view full_name);

/// Hashes of passwords for logging in (Argon2id; the text holds salt and cost).
class PasswordHasher {
  public:
    explicit PasswordHasher(GuessCost cost);

    [[nodiscard]] std::string hash(std::string_view password) const;

    /// Whether the password is the one that was hashed. Of a person who does not exist, `stored` is nothing:
    /// the answer is no and takes as long as any other, so that it does not tell who has an account.
    [[nodiscard]] bool matches(const std::optional<std::string>& stored, std::string_view password) const;

    /// Whether the hash was made at another cost than today's; then it is made anew at the next log-in.
    [[nodiscard]] bool is_stale(const std::string& stored) const;

  private:
    GuessCost m_cost;
    std::string m_nobody;  ///< the hash of a password that nobody knows
};

}  // namespace weave::loomlink
