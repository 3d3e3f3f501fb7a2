// Slices as text from anywhere: refused with a reason, or a design that can be kept, and the same slices again.
#include "support/must.hpp"
#include "support/small_cloth.hpp"

#include <weave/design/document.hpp>
#include <weave/io/slices_text.hpp>

using namespace weave;
using fuzz::must;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const System dots = data[0] % 2 == 0 ? System::weft : System::warp;
    const auto read = read_slices(fuzz::text_of(data + 1, size - 1), dots);
    if (!read) {
        must(!read.error().message.empty(), "a refusal says why");
        return 0;
    }
    std::string text;
    for (const Slice& slice : *read) {
        for (const auto& position : slice.positions) text += to_text(position) + "\n";
        text += "\n";
    }
    const auto again = read_slices(text, dots);
    must(static_cast<bool>(again), "what was written can be read");
    must(*again == *read, "the slices come back");
    const Design design = design_of_slices(*read);
    if (const auto cloth = fuzz::small_cloth(design)) must(static_cast<bool>(read_document(write_document(design))), "a design of slices can be kept");
    return 0;
}
