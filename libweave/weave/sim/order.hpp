#pragma once

#include <weave/curve/cloth_curves.hpp>
#include <weave/curve/spline.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace weave::sim {

/// A yarn's centreline with what finds its key points again.
struct LaidYarn {
    const Spline& spline;
    double per_key = 1;  ///< parameter from one key point to the next
    double begin = 0;    ///< of a piece of a yarn: the parameter of the whole at which it begins

    [[nodiscard]] double at(std::size_t key) const { return per_key * static_cast<double>(key) - begin; }
};

/// Where two yarns cross, seen from above.
struct CrossingSpot {
    double weft_at = 0, warp_at = 0;  ///< parameters of the two splines
    double height_mm = 0;             ///< of the weft above the warp
};

/// The crossing of two yarns nearest to their key points, at most three key points away; nothing where they
/// do not cross there.
std::optional<CrossingSpot> find_crossing(const LaidYarn& weft, const LaidYarn& warp, std::size_t weft_key,
                                          std::size_t warp_key);

/// The same for a crossing of planned curves, from its planned place on. `splines` as for lost_crossings().
std::optional<CrossingSpot> find_crossing(const ClothCurves& curves, const std::vector<Spline>& splines,
                                          const Crossing& crossing);

/// A crossing that does not lie as the card image says, or that was not found again.
struct LostCrossing {
    Crossing crossing;
    bool found = true;  ///< whether the yarns still cross near their planned place
};

/// What became of the crossings of a card image in relaxed yarns.
struct CrossingOrder {
    std::vector<LostCrossing> lost;  ///< a yarn passed through the other, or slipped off its end
    /// No longer seen where they were planned, though nothing passed through anything: the yarns hang apart
    /// in cloth that stands open, or one lay over the other without being held and slid off.
    std::vector<LostCrossing> slid;
};

/// Yarns as planned and as they lie now, with as many control points: one entry each for what crossings
/// index. An empty spline was left out, and so are its crossings.
struct OrderSubject {
    std::vector<Spline> planned, now;
    std::vector<double> per_key;        ///< parameter from one key point of a yarn to the next
    std::array<double, 2> period_mm{};  ///< 0 in directions that do not repeat
    std::vector<double> begin = {};     ///< LaidYarn::begin, of each; empty: all are whole

    /// One of `planned` or `now`.
    [[nodiscard]] LaidYarn laid_yarn(const std::vector<Spline>& splines, std::size_t yarn) const {
        return {splines[yarn], per_key[yarn], begin.empty() ? 0 : begin[yarn]};
    }
};

/// Looks every crossing up in the relaxed yarns: where the projections of its two yarns cross, from the
/// planned place on, and which lies above; where cloth stands on edge or hangs over, which lies on which side
/// where they are nearest. What is in doubt so is decided by how often its two yarns pass over one another in
/// all (linking.hpp).
CrossingOrder crossing_order(const std::vector<Crossing>& crossings, const OrderSubject& subject);

/// The same for planned curves; `splines` has one entry for each yarn of `curves`.
CrossingOrder crossing_order(const ClothCurves& curves, const std::vector<Spline>& splines);

/// Only those that are lost.
std::vector<LostCrossing> lost_crossings(const ClothCurves& curves, const std::vector<Spline>& splines);

}  // namespace weave::sim
