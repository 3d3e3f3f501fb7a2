// JSON from anywhere: refused with a reason, or values whose canonical bytes stand still.
#include "support/must.hpp"

#include <weave/core/json.hpp>

using namespace weave;
using fuzz::must;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto value = parse_json(fuzz::text_of(data, size));
    if (!value) {
        must(!value.error().message.empty(), "a refusal says why");
        return 0;
    }
    const std::string canonical = canonical_json(*value);
    const auto again = parse_json(canonical);
    must(static_cast<bool>(again), "canonical bytes are JSON");
    must(canonical_json(*again) == canonical, "canonical bytes of canonical bytes are the same");

    const auto indented = parse_json(value->dump(2));
    must(static_cast<bool>(indented), "what was parsed can be written and parsed");
    must(*indented == *value, "parsing what was written gives an equal value");
    must(canonical_json(*indented) == canonical, "spaces change nothing in the canonical bytes");
    return 0;
}
