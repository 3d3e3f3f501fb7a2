// A file of local tokens from anywhere: refused with its line, or people under hashes.
#include "support/must.hpp"

#include <simd/service/local_tokens.hpp>

using namespace weave;
using fuzz::must;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto people = simd::parse_local_tokens(fuzz::text_of(data, size));
    if (!people) {
        must(people.error().where.starts_with("line "), "a refusal names the line");
        return 0;
    }
    for (const auto& [hash, person] : *people) {
        must(hash.size() == 64 && hash.find_first_not_of("0123456789abcdef") == std::string::npos, "a hash is one");
        must(!person.empty() && person != "local" && person.size() <= 100, "a name is one");
    }
    return 0;
}
