// A trust document from anywhere, as it is and as a body that was soundly signed: refused, or one that can be
// followed.
#include "support/must.hpp"
#include "support/signed.hpp"

using namespace weave;
using namespace weave::loomlink;
using fuzz::must;

namespace {

void try_bytes(std::string_view bytes) {
    const auto trust = read_trust(bytes);
    if (!trust) {
        must(!trust.error().message.empty(), "a refusal says why");
        return;
    }
    must(write_signed(trust->document) == bytes, "a document has one sequence of bytes");
    must(canonical_json(trust_body(*trust)) == canonical_json(trust->document.body),
         "a document says what was read");
    for (const TrustedKey& key : trust->keys) must(trust->find(key.id()) != nullptr, "every key is found");
    if (const auto next = next_trust(fuzz::one_site(), bytes))
        must(next->version == 2 && next->site == "mill", "only the next version of a site follows");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::text_of(data, size);
    try_bytes(text);
    try_bytes(fuzz::signed_by_site(text, Purpose::trust_document, Role::root));
    return 0;
}
