// A checkpoint from anywhere, and a body from anywhere under the hash that fits it: refused, or one whose numbers are numbers.
#include "support/must.hpp"

#include <weave/core/sha256.hpp>

#include <simd/worker/checkpoint.hpp>

using namespace weave;
using fuzz::must;

namespace {

void check(std::string_view bytes, bool may_be_one) {
    const auto checkpoint = simd::parse_checkpoint(bytes);
    if (!checkpoint) return must(!checkpoint.error().message.empty(), "a refusal says why");
    must(may_be_one, "no bytes pass without their hash");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes = fuzz::text_of(data, size);
    check("weave checkpoint 1\n" + sha256_hex(bytes) + "\n" + std::string(bytes), true);
    check("weave checkpoint 1\n" + std::string(64, '0') + "\n" + std::string(bytes), false);
    check(bytes, bytes.find(sha256_hex(bytes.substr(std::min<std::size_t>(bytes.size(), 84)))) != std::string_view::npos);
    return 0;
}
