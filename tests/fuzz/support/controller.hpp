#pragma once

#include <weave/loom/profile.hpp>

#include <cstdint>
#include <string_view>

namespace weave::fuzz {

/// A controller file from anywhere, read for small looms of this kind: 32 hooks of all uses, in several
/// readings. It is refused with a place and a reason, or its size is what it says. What was read without a
/// warning is encoded again, by the tests' own encoder, to the same bytes.
void try_controller(std::string_view bytes, OutputFormat format);

}  // namespace weave::fuzz
