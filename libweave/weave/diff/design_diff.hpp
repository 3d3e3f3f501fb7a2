#pragma once

#include <weave/block/block_grid.hpp>
#include <weave/block/card_image.hpp>
#include <weave/core/json.hpp>
#include <weave/core/result.hpp>
#include <weave/design/design.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/diff/card_diff.hpp>
#include <weave/diff/change.hpp>
#include <weave/diff/tree_diff.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace weave {

/// What comparing needs of a cloth, far less than its stacks.
struct WovenCloth {
    CardImage card;
    BlockGrid grid;
    std::size_t height = 0;
};

/// A design with its cloth; where none can be made of it, why.
struct WovenDesign {
    Design design;
    std::optional<WovenCloth> cloth;
    std::string no_cloth;              ///< why there is no cloth; empty where there is one
    std::vector<LostFlip> lost_flips;  ///< see Evaluation
};

/// Weaves a design and lets go of its stacks, so that of two designs only one block at a time is in memory.
/// One whose cloth cannot be made is no error: it can be compared in all but its card. Running out of memory
/// is one.
Result<WovenDesign> weave_design(Design design);

/// All in which two designs differ. `before` and `after` are as they were given; a diff the other way round
/// is its mirror image, with the same counts.
struct DesignDiff {
    TreeDiff tree;
    std::optional<CardDiff> card;  ///< absent where a design has no cloth
    std::string no_card;           ///< why it is absent
    Changes picks;                 ///< inserted, removed, moved; another feeder, yarn, direction or take-up
    Changes ends;                  ///< inserted, removed, moved
    Changes yarns;                 ///< yarn types, feeders, beams, colours, and ends that use others
    Changes parameters;            ///< title, notes, size of the cloth, t and p, densities, reed, scene
    bool view_differs = false;     ///< what a program with windows keeps; no part of the design

    /// Whether the documents mean the same, whatever their views.
    [[nodiscard]] bool is_same() const {
        return tree.is_same() && (!card || card->is_same()) && picks.empty() && ends.empty() &&
               yarns.empty() && parameters.empty();
    }
};

/// Compares two designs that pass check(). Whatever differs between their documents is told in some section,
/// the view alone by `view_differs`. Takes memory of some six cards and, for the picks, of one pick table.
DesignDiff diff_designs(const WovenDesign& before, const WovenDesign& after);

/// The answer of `weave diff --json`: `equal`, `tree`, `root`, `pixels`, `picks`, `ends`, `yarns`,
/// `parameters`, `view_differs`, `counts`. Picks, ends, rows and columns from 1; lists hold at most
/// `most_listed` entries, and `counts` says how many there are.
Json to_json(const DesignDiff& diff);

/// For people: a summary, then a section for each part that differs. Lists are cut, with a count. `before`
/// and `after` are what the designs are called.
std::string in_words(const DesignDiff& diff, const std::string& before, const std::string& after);

/// One line about the card: `12 of 960 crossings differ (1.25 %): 8 ends lifted, 4 lowered`.
std::string in_words(const CardDiff& diff);

}  // namespace weave
