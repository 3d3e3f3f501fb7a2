#pragma once

#include <weave/sim/order.hpp>
#include <weave/sim/yarns.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace weave::sim {

/// One crossing of a relaxed cloth: where its two key points were planned, where they lie now, and where the
/// yarns really cross. Lengths mm.
struct CrossingPlace {
    Vec3 planned_weft, planned_warp, weft, warp;
    std::optional<CrossingSpot> spot;  ///< nothing where the yarns no longer cross there
};

/// Looks every crossing up, in the order of `yarns.crossings`. Errors: a report without `points_per_key`,
/// which tells where the key points lie on the splines; a key point beyond its yarn.
Result<std::vector<CrossingPlace>> crossing_places(const Yarns& yarns);

/// The yarns of a cloth, planned and relaxed, for crossing_order(). Errors as those of crossing_places().
Result<OrderSubject> order_subject(const Yarns& yarns);

/// What one pick, or one end, does at its crossings. In wraparound a yarn has several picks; a pick with two
/// feeders has two strands.
struct Strand {
    System system = System::warp;
    std::size_t number = 0;              ///< the pick or end, from 0
    std::size_t yarn = 0;                ///< index into Yarns::yarns
    std::size_t sheet = 0;               ///< see sheets_of
    std::vector<std::size_t> crossings;  ///< indices, along the yarn
    Vec3 planned{0, 0, 0};               ///< mean over the crossings
    Vec3 moved{0, 0, 0};                 ///< mean of now less planned
};

/// The strands of a cloth, wefts before warps, each by number. `counted` tells for each crossing whether it counts;
/// empty: all do.
std::vector<Strand> strands_of(const Yarns& yarns, const std::vector<CrossingPlace>& places,
                               const std::vector<char>& counted = {});

/// For each yarn the number of its sheet. Yarns of one sheet hold one another: from each of them a way leads
/// to each other, always from a yarn to one that lies above it at a crossing. So a cloth of several sheets
/// falls apart into them: each lies wholly above or below the next. Sheets are numbered from the lowest.
/// Linear in the crossings.
std::vector<std::size_t> sheets_of(const Yarns& yarns);

}  // namespace weave::sim
