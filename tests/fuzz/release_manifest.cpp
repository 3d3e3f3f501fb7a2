// The manifest of a release from anywhere, as it is and as a body that was soundly signed: refused, or one
// whose files lie side by side and harm nothing.
#include "support/must.hpp"
#include "support/signed.hpp"

#include <loomlink/keys/file_name.hpp>
#include <loomlink/keys/release_manifest.hpp>
#include <set>

using namespace weave;
using namespace weave::loomlink;
using fuzz::must;

namespace {

void try_bytes(std::string_view bytes) {
    const auto manifest = open_manifest(bytes, fuzz::one_site());
    if (!manifest) {
        must(!manifest.error().message.empty(), "a refusal says why");
        return;
    }
    must(canonical_json(manifest_body(*manifest)) == canonical_json(manifest->document.body),
         "a manifest says what was read");
    std::set<std::string> names{manifest_name};
    std::uint64_t bytes_in_all = 0;
    for (const ReleasedFile& file : manifest->files) {
        must(static_cast<bool>(check_file_name(file.path)), "a file name is harmless");
        must(names.insert(folded_name(file.path)).second, "no two files have one name");
        bytes_in_all += file.size;
    }
    must(bytes_in_all <= most_release_bytes, "a release has its bounds");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::text_of(data, size);
    try_bytes(text);
    try_bytes(fuzz::signed_by_site(text, Purpose::release_manifest, Role::release));
    return 0;
}
