#include <studio/commands/flip_crossing.hpp>

#include <weave/block/flip.hpp>

#include <QCoreApplication>

namespace weave::studio {

namespace {

/// The stack of a crossing of the design as it stands, also while its block is still being made.
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

}  // namespace

Result<EditStep> flip_crossing(const Document& document, const CardPlace& place) {
    WEAVE_TRY(const PlacedStack at, stack_now(document, place));
    WEAVE_CHECK_OK(flip(at, place.pick, place.end));
    const bool weft_over = at.stack.weft_over(place.pick - at.first_pick, place.end - at.first_end);
    return EditStep{QCoreApplication::translate("commands", "Flip pick %1, end %2").arg(place.pick + 1).arg(place.end + 1),
                    {PutFlip{document.shown_block(), Flip{place.pick, place.end, !weft_over}}}};
}

}  // namespace weave::studio
