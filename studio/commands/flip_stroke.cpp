#include <studio/commands/flip_stroke.hpp>

#include <weave/block/flip.hpp>

#include <studio/document/stack_now.hpp>

#include <QCoreApplication>

#include <map>
#include <optional>
#include <utility>

namespace weave::studio {

namespace {

struct Words {
    Q_DECLARE_TR_FUNCTIONS(commands)
};

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

FlippedStroke flip_stroke(const Document& document, std::span<const CardPlace> places) {
    FlippedStroke flipped;
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
                            ? Words::tr("Flip pick %1, end %2").arg(places[0].pick + 1).arg(places[0].end + 1)
                            : Words::tr("Flip %n crossing(s)", nullptr, static_cast<int>(flipped.flipped));
    return flipped;
}

}  // namespace weave::studio
