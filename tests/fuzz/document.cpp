// A `.weave` document from anywhere: refused with a reason, or a design that writes and reads as itself.
#include "support/must.hpp"
#include "support/small_cloth.hpp"

#include <weave/design/document.hpp>

using namespace weave;
using fuzz::must;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::text_of(data, size);
    if (!fuzz::runs_are_short(text)) return 0;
    const auto design = read_document(text);
    if (!design) {
        must(!design.error().message.empty(), "a refusal says why");
        return 0;
    }
    const std::string written = write_document(*design);
    const auto again = read_document(written);
    must(static_cast<bool>(again), "what was written can be read");
    must(*again == *design, "reading what was written gives an equal design");
    must(write_document(*again) == written, "writing again gives the same bytes");
    must(design_sha256(*again) == design_sha256(*design), "equal designs have the same hash");
    must(scene_sha256(*again) == scene_sha256(*design), "equal scenes have the same hash");

    const auto cloth = fuzz::small_cloth(*design);
    if (!cloth) return 0;
    const CardImage card = cloth->block->card_image();
    must(card.picks() == cloth->block->picks() && card.ends() == cloth->block->ends(),
         "the card covers the cloth");
    const auto cloth_again = fuzz::small_cloth(*again);
    must(cloth_again && *cloth_again->block == *cloth->block, "equal designs give equal cloth");
    must(cloth_again->lost_flips.size() == cloth->lost_flips.size(), "equal designs lose the same flips");
    return 0;
}
