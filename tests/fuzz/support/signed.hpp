#pragma once

#include <loomlink/keys/trust.hpp>
#include <string_view>

namespace weave::fuzz {

/// The key of one seed that signs for every role of a made-up site, so that a run can be repeated.
const KeyPair& one_key(loomlink::Role role);

/// The trust document of that site: one root and releaser, one stamp and one log key.
const loomlink::TrustDocument& one_site();

/// The document that the fuzzer's text holds as its body, soundly signed: what lies behind the signature is
/// reached by hostile bytes as well. Empty where the text is no JSON object.
std::string signed_by_site(std::string_view body, Purpose purpose, loomlink::Role role);

}  // namespace weave::fuzz
