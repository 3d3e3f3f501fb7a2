// A sealed key from anywhere: refused with a reason, or one that reads as it was written and costs what may
// be spent.
#include "support/must.hpp"

#include <loomlink/keys/sealed_key.hpp>

using namespace weave;
using namespace weave::loomlink;
using fuzz::must;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto key = read_sealed_key(fuzz::text_of(data, size));
    if (!key) {
        must(!key.error().message.empty(), "a refusal says why");
        return 0;
    }
    must(is_affordable(key->cost), "no key costs more to open than may be spent");
    const std::string written = write_sealed_key(*key);
    const auto again = read_sealed_key(written);
    must(again && write_sealed_key(*again) == written, "a key reads as it was written");
    return 0;
}
