#pragma once

#include <weave/block/flip.hpp>
#include <weave/design/evaluate.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace weave {

/// A crossing of a cloth; pick and end from 0.
struct CardPlace {
    std::size_t pick = 0, end = 0;
};

/// What can be said of a cloth without laying out all its stacks.
struct Outline {
    BlockGrid grid;
    std::size_t height = 0;
    std::vector<LostFlip> lost_flips;  ///< of the root and of all that it is made from
    std::optional<PlacedStack>
        at;  ///< the stack of the crossing that was asked for; none where it is outside
};

/// The outline of the cloth of a design. It is that of evaluate(), errors included, but as far as possible
/// only the stacks at flips and at the crossing asked for are made, so that a cloth of 400 million crossings
/// is told in milliseconds from its counts. Only what cannot be told so is evaluated: what is refused for more
/// than its counts, cards read with several picks and ends a cell, thousands of flips on deep trees.
Result<Outline> outline(const Design& design, std::optional<CardPlace> place = {});

}  // namespace weave
