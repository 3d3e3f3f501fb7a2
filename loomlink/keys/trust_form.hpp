#pragma once

#include <loomlink/keys/trust.hpp>

namespace weave::loomlink {

/// The form of a trust document without a look at its signatures; read_trust() is what to call.
Result<TrustDocument> read_trust_form(std::string_view bytes);

}  // namespace weave::loomlink
