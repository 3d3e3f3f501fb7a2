#include <studio/commands/flip_crossing.hpp>

#include <weave/block/flip.hpp>

#include <studio/document/stack_now.hpp>

#include <QCoreApplication>

namespace weave::studio {

Result<EditStep> flip_crossing(const Document& document, const CardPlace& place) {
    WEAVE_TRY(const PlacedStack at, stack_now(document, place));
    WEAVE_CHECK_OK(flip(at, place.pick, place.end));
    return EditStep{QCoreApplication::translate("commands", "Flip pick %1, end %2").arg(place.pick + 1).arg(place.end + 1),
                    {PutFlip{document.shown_block(), Flip{place.pick, place.end, !weft_over(at, place)}}}};
}

}  // namespace weave::studio
