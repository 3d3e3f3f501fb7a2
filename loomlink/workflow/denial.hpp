#pragma once

#include <weave/core/result.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace weave::loomlink {

/// Why something is not done for a caller: each stands for one status of HTTP. An Error of code `refused` has
/// its word (`who`, `password`, `rights`, `absent`, `conflict`, `often`) as `where`.
enum class Denial : std::uint8_t {
    who,       ///< nobody is signed in (401)
    password,  ///< the password typed for a signature is wrong (403)
    rights,    ///< not this person's to do (403)
    absent,    ///< there is no such thing, or none that this person may know of (404)
    conflict,  ///< not in this state, or somebody else was first (409)
    often,     ///< too many tries (429)
};

const char* word(Denial denial);

/// An Error of code `refused`. The message is a sentence for the person.
Error deny(Denial denial, std::string message);

/// The denial of an error that deny() made. A refusal of the store's own rules is a conflict; other errors
/// are none.
std::optional<Denial> denial_of(const Error& error);

}  // namespace weave::loomlink
