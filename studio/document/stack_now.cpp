#include <studio/document/stack_now.hpp>

#include <weave/block/flip.hpp>

namespace weave::studio {

Result<PlacedStack> stack_now(const Document& document, const CardPlace& place) {
    if (const BlockPtr& block = document.shown().block; block && document.shown_is_current()) {
        if (place.pick >= block->picks() || place.end >= block->ends()) return no_crossing(block->grid(), place.pick, place.end);
        return stack_at(*block, place.pick, place.end);
    }
    Design design = document.design();
    design.root = document.shown_block();
    WEAVE_TRY(const Outline seen, outline(design, place));
    if (!seen.at) return no_crossing(seen.grid, place.pick, place.end);
    return *seen.at;
}

bool weft_over(const PlacedStack& at, const CardPlace& place) {
    return at.stack.weft_over(place.pick - at.first_pick, place.end - at.first_end);
}

}  // namespace weave::studio
