#pragma once

#include <weave/core/result.hpp>

#include <string>
#include <string_view>

namespace weave {

/// A one-time code that a person reads and types, for an invitation or for enrolling a machine: six groups of
/// four from digits and small letters without those that look alike (0 1 i l o), such as `k7tq-…`; 118 bits.
std::string make_code();

/// The SHA-256 of a code as typed, whatever its case, with or without hyphens and spaces: what is stored and
/// looked up. An error for what make_code() never makes.
Result<std::string> code_hash(std::string_view typed);

/// A secret that programs pass on: a session, a CSRF token. 32 random bytes as 43 characters of base64url.
std::string make_token();

/// The SHA-256 of a token: what is stored, so that who reads the store can log in as nobody.
std::string token_hash(std::string_view token);

}  // namespace weave
