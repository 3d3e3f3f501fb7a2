#pragma once

#include <weave/block/block_grid.hpp>
#include <weave/design/design.hpp>
#include <weave/diff/card_diff.hpp>
#include <weave/diff/change.hpp>
#include <weave/diff/list_diff.hpp>

#include <cstddef>

namespace weave {

/// Which yarn, feeder, beam and colour of one design is which of another.
struct PlanPartners {
    PlanPartners(const Design& before, const Design& after);
    ListPartners warp_yarns, beams, colours, weft_yarns, feeders;
};

/// Yarn types, feeders, beams and colours: those added, removed, changed and put in another order.
Changes diff_yarn_lists(const Design& before, const Design& after, const PlanPartners& partners);

/// Ends that use another yarn, beam or colour than the end that they were, by a `cloth` laid on the other;
/// and orders that are written otherwise and change nothing there. Without a cloth the orders as they are
/// written.
Changes diff_end_uses(const Design& before, const Design& after, const PlanPartners& partners,
                      const LineAlignment* ends);

/// Picks that have another feeder, yarn, direction or take-up than the pick that they were; as
/// diff_end_uses(). The grids are those of the two cloths.
struct PickLines {
    const BlockGrid &before, &after;
    const LineAlignment& picks;
};
Changes diff_pick_uses(const Design& before, const Design& after, const PlanPartners& partners,
                       const PickLines* lines);

/// Picks (or ends) that were inserted, removed or moved.
Changes diff_lines(const LineAlignment& lines, const std::vector<MovedLine>& moved, System system);

/// Title, notes, densities, reed and the scene.
Changes diff_parameters(const Design& before, const Design& after);

}  // namespace weave
