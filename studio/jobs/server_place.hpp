#pragma once

#include <weave/wire/place.hpp>

#include <string>

namespace weave::studio {

/// A simulation server as a person names it.
struct ServerWish {
    std::string host;        ///< `box`, `box:8444`, `https://box:8444` or `unix:PATH`
    std::string token_file;  ///< empty: the file that WEAVE_TOKEN_FILE names, or the token in WEAVE_TOKEN, as
                             ///< `weave --on` has it
    std::string fingerprint;  ///< SHA-256 of its certificate, where no authority signed it
    friend bool operator==(const ServerWish&, const ServerWish&) = default;
};

/// Where that server is, with the token to speak to it; reads a file. Errors: no such place, no readable
/// token.
Result<wire::ServerPlace> place_of(const ServerWish& wish);

}  // namespace weave::studio
