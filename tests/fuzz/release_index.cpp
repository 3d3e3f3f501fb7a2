// A release index from anywhere, as it is and as a body that was soundly stamped: refused, or one that reads
// as it was written.
#include "support/must.hpp"
#include "support/signed.hpp"

#include <loomlink/keys/release_index.hpp>

using namespace weave;
using namespace weave::loomlink;
using fuzz::must;

namespace {

void try_bytes(std::string_view bytes) {
    const auto index = open_index(bytes, fuzz::one_site());
    if (!index) {
        must(!index.error().message.empty(), "a refusal says why");
        return;
    }
    const Json body = index_body(*index);
    must(write_signed({body, {sign_body(fuzz::one_key(Role::stamp), Purpose::release_index, body)}}) == bytes,
         "an index reads as it was written");
    must(index->expires - index->issued <= longest_validity, "no index holds for long");
    for (const IndexEntry& entry : index->releases)
        must(*index->find(entry.number) == entry, "a number stands once");
}

/// The text as a body whose head the log's key signed, where it has one.
std::string stamped(std::string_view text) {
    auto json = parse_json(text);
    if (!json || !json->is_object()) return {};
    if (json->contains("tree_head")) {
        if (const auto head = head_from_json((*json)["tree_head"]))
            (*json)["tree_head"] = to_json(sign_head(fuzz::one_key(Role::log), head->head));
    }
    return fuzz::signed_by_site(canonical_json(*json), Purpose::release_index, Role::stamp);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::text_of(data, size);
    try_bytes(text);
    try_bytes(stamped(text));
    return 0;
}
