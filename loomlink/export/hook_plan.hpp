#pragma once

#include <weave/block/card_image.hpp>
#include <weave/design/design.hpp>
#include <weave/loom/pick_table.hpp>
#include <weave/loom/profile.hpp>

#include <cstddef>
#include <cstdint>
#include <loomlink/export/lift_table.hpp>
#include <vector>

namespace weave::loomlink {

/// No controller's file, and no plan of one, is larger.
inline constexpr std::size_t most_file_bytes = std::size_t{1} << 28;

/// What every hook and every function bit does on every pick: all that a controller's file says, before any
/// bytes.
struct HookPlan {
    LiftTable lifts;                                ///< lead-in picks first
    std::vector<std::uint64_t> function_words;      ///< of each pick; bit n is function bit n
    std::vector<std::vector<std::size_t>> feeders;  ///< the loom's, from 0, of each pick
    std::vector<HookUse> uses;                      ///< of each hook
    std::size_t lead_in = 0;                        ///< picks before the design's first
};

/// The feeders of the loom, from 0, that a pick takes. Errors: a feeder of the design that the map leaves out
/// or takes beyond the loom's, two on one feeder of the loom, more than the loom presents at once.
Result<std::vector<std::size_t>> loom_feeders(const Pick& pick, std::size_t number, const FeederMap& map,
                                              const LoomProfile& profile);

/// Lifts and function words of a cloth on a loom.
///  - An end's hooks lift where the pick does not lie over it (`card`), by the profile's rule.
///  - Selvedge hooks follow the selvedge weave, pick 1 of the design at its first line.
///  - Constant-on hooks lift on every pick, lead-in too; regulator hooks on picks after which the cloth
///  stands still.
///  - The feeders select function bits or hooks by the profile's encoding.
///  - Hooks that are cast out never lift: an error where anything would make them.
///
/// `picks` is the pick table of one repeat; its length is the card's. `feeders` maps each feeder that the
/// picks take; two may share one of the loom's where both carry the same yarn. Errors name the pick or end,
/// from 1.
Result<HookPlan> plan_hooks(const weave::Design& design, const CardImage& card, const std::vector<Pick>& picks,
                            const LoomProfile& profile, const FeederMap& feeders);

}  // namespace weave::loomlink
