#include <weave/keys/sodium.hpp>

#include <weave/core/log.hpp>

#include <cstdlib>
#include <sodium.h>

namespace weave {

void need_sodium() {
    static const bool ready = [] { return sodium_init() >= 0; }();
    if (ready) return;
    log(LogLevel::warning, "libsodium cannot start: the system gives no random bytes");
    std::abort();
}

}  // namespace weave
