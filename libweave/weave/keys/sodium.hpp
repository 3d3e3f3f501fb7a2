#pragma once

namespace weave {

/// Makes libsodium ready, once; whatever calls libsodium calls this first. A system without randomness is no
/// place for keys: the program ends there.
void need_sodium();

}  // namespace weave
