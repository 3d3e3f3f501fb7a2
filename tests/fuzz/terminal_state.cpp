// The state of a terminal from anywhere, with its own trust and with a sound one: refused, or one that reads
// as it was written.
#include "support/must.hpp"
#include "support/signed.hpp"

#include <loomlink/keys/file_name.hpp>
#include <loomlink/terminal/state.hpp>

using namespace weave;
using namespace weave::loomlink;
using fuzz::must;

namespace {

void try_bytes(std::string_view bytes) {
    const auto state = read_state(bytes);
    if (!state) {
        must(!state.error().message.empty(), "a refusal says why");
        return;
    }
    const std::string written = write_state(*state);
    const auto again = read_state(written);
    must(again && write_state(*again) == written, "a state reads as it was written");
    for (const PlacedRelease& placed : state->placed) {
        must(static_cast<bool>(check_file_name(placed.folder)) && placed.within.is_absolute(), "a folder to remove is harmless");
        for (const PlacedFile& file : placed.files)
            must(static_cast<bool>(check_file_name(file.path)), "a file to remove is harmless");
    }
}

/// The text with the trust of the made-up site, whose log's key signed the head.
std::string trusted(std::string_view text) {
    auto json = parse_json(text);
    if (!json || !json->is_object()) return {};
    (*json)["trust"] = to_json(fuzz::one_site().document);
    if (json->contains("tree_head")) {
        if (const auto head = head_from_json((*json)["tree_head"]))
            (*json)["tree_head"] = to_json(sign_head(fuzz::one_key(Role::log), head->head));
    }
    return canonical_json(*json);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::text_of(data, size);
    try_bytes(text);
    try_bytes(trusted(text));
    return 0;
}
