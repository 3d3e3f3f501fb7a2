// WIF files from anywhere: refused with a reason, or a design whose cloth survives our own WIF.
#include "support/must.hpp"
#include "support/small_cloth.hpp"

#include <weave/design/document.hpp>
#include <weave/io/wif.hpp>

using namespace weave;
using fuzz::must;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::text_of(data, size);
    const auto read = read_wif(text);
    if (!read) {
        must(!read.error().message.empty(), "a refusal says why");
        return 0;
    }
    const Design& design = read->design;
    must(static_cast<bool>(check(design)), "a design from a WIF file is sound");
    const auto cloth = fuzz::small_cloth(design);
    if (!cloth) return 0;
    const CardImage card = cloth->block->card_image();
    const auto written = write_wif(design, *cloth->block, card);
    must(static_cast<bool>(written), "a design from a WIF file can be written as one");
    const auto again = read_wif(*written);
    must(static_cast<bool>(again), "what was written can be read");
    const auto cloth_again = evaluate(again->design);
    must(static_cast<bool>(cloth_again), "what was read can be woven");
    must(cloth_again->block->card_image() == card, "the card comes back");
    must(cloth_again->block->t() == cloth->block->t() && cloth_again->block->p() == cloth->block->p(),
         "t and p come back");
    must(again->design.title == design.title, "the title comes back");
    must(static_cast<bool>(read_document(write_document(again->design))), "an imported design can be kept");
    return 0;
}
