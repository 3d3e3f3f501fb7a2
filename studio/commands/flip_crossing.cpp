#include <studio/commands/flip_crossing.hpp>

#include <weave/block/flip.hpp>

#include <QCoreApplication>

#include <map>
#include <utility>

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

bool weft_over(const PlacedStack& at, const CardPlace& place) {
    return at.stack.weft_over(place.pick - at.first_pick, place.end - at.first_end);
}

/// The stacks of a stroke as its flips leave them, by their first pick and end.
class Stacks {
  public:
    explicit Stacks(const Document& document) : m_document(document) {}

    Result<PlacedStack> at(const CardPlace& place) {
        for (const auto& [first, kept] : m_changed) {
            if (holds(kept, place)) return kept;
        }
        return stack_now(m_document, place);
    }
    void keep(PlacedStack changed) {
        const std::pair first{changed.first_pick, changed.first_end};
        m_changed.insert_or_assign(first, std::move(changed));
    }

  private:
    static bool holds(const PlacedStack& stack, const CardPlace& place) {
        return place.pick >= stack.first_pick && place.pick < stack.first_pick + stack.stack.wefts() && place.end >= stack.first_end &&
               place.end < stack.first_end + stack.stack.warps();
    }

    const Document& m_document;
    std::map<std::pair<std::size_t, std::size_t>, PlacedStack> m_changed;
};

}  // namespace

Result<EditStep> flip_crossing(const Document& document, const CardPlace& place) {
    WEAVE_TRY(const PlacedStack at, stack_now(document, place));
    WEAVE_CHECK_OK(flip(at, place.pick, place.end));
    return EditStep{QCoreApplication::translate("commands", "Flip pick %1, end %2").arg(place.pick + 1).arg(place.end + 1),
                    {PutFlip{document.shown_block(), Flip{place.pick, place.end, !weft_over(at, place)}}}};
}

FlippedCrossings flip_crossings(const Document& document, std::span<const CardPlace> places) {
    FlippedCrossings flipped;
    Stacks stacks(document);
    std::optional<bool> side;
    for (const CardPlace& place : places) {
        auto at = stacks.at(place);
        if (!at) {
            flipped.refused.push_back({place, std::move(at).error()});
            continue;
        }
        const bool over = weft_over(*at, place);
        if (!side) side = !over;
        if (over == *side) continue;
        auto stack = flip(*at, place.pick, place.end);
        if (!stack) {
            flipped.refused.push_back({place, std::move(stack).error()});
            continue;
        }
        at->stack = std::move(*stack);
        stacks.keep(std::move(*at));
        flipped.step.edits.push_back(PutFlip{document.shown_block(), Flip{place.pick, place.end, *side}});
        ++flipped.flipped;
    }
    flipped.step.text = flipped.flipped == 1 && !places.empty()
                            ? QCoreApplication::translate("commands", "Flip pick %1, end %2").arg(places[0].pick + 1).arg(places[0].end + 1)
                            : QCoreApplication::translate("commands", "Flip %1 crossings").arg(flipped.flipped);
    return flipped;
}

}  // namespace weave::studio
