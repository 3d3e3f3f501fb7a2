#pragma once

#include <weave/core/result.hpp>
#include <weave/net/client.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace weave::wire {

/// The port of simd where a place names none.
inline constexpr std::uint16_t usual_port = 8444;
/// No bearer token is longer.
inline constexpr std::size_t most_token_bytes = 4096;

/// Where a simd is, and as whom to speak with it.
struct ServerPlace {
    net::ClientOptions options;
    std::string name;   ///< as messages for people have it: `box:8444`
    std::string token;  ///< a secret: it goes to the server alone, and into no message; empty: none
};

/// Whether a host is the machine itself, so that plain HTTP to it is heard by nobody on the way. A name that only
/// begins like such an address, as 127.0.0.1.evil.example, is another machine's.
bool is_this_machine(const std::string& host);

/// The place that a person names: `box` and `box:9000` (TLS; port 8444 where none is said), `https://box:8444`,
/// `http://127.0.0.1:9000` (plain, within this machine alone), `unix:/path/of/socket` (or a path from the working
/// folder on). Errors (bad_input): none of these; plain HTTP to another machine, where everybody on the way could read the token.
Result<ServerPlace> place_of(const std::string& text);

/// Speaks with a token from here on, as a file holds it: white space around it is left away. Errors (bad_input), which
/// do not repeat it: empty, longer than 4,096 bytes, or with other characters than a bearer token has (RFC 6750).
Status use_token(ServerPlace& place, std::string_view text);

}  // namespace weave::wire
