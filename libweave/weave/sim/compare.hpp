#pragma once

#include <weave/sim/centreline.hpp>
#include <weave/sim/measured.hpp>
#include <weave/sim/yarns.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace weave {

/// Yarns that were measured, or simulated by something else.
struct MeasuredCloth {
    std::vector<MeasuredYarn> yarns;
    /// Which yarn of a cloth each is, where its file says so (a `.yarns` file); else empty, and order counts.
    std::vector<SimulatedYarn> names;
};

/// A scan as text (MEASURED.md) or a `.yarns` file, told apart by its first bytes. Errors as the two readers
/// give them.
Result<MeasuredCloth> read_measured_cloth(std::string_view bytes);

enum class MatchedBy {
    name,      ///< both files name their picks and ends
    order,     ///< as many yarns in both: first to first, and so on
    nearness,  ///< else each measured yarn is that one which lies nearest once the two lie on one another
};

struct YarnDeviation {
    std::size_t measured = 0;   ///< index into the measured yarns
    std::size_t simulated = 0;  ///< index into Yarns::yarns
    double rms_mm = 0, max_mm = 0;
    Vec3 worst{0, 0, 0};  ///< place in the simulated cloth where it is greatest
};

/// Another matching under which the measured yarns fit far better.
struct OtherMatching {
    double rms_mm = 0, max_mm = 0;
};

/// A unit in which the measured lengths fit far better than in mm.
struct UnitHint {
    std::string unit;                         ///< such as `µm`
    double mm = 1;                            ///< that one of it is
    double rms_mm = 0;                        ///< if they are in it
    MatchedBy matched_by = MatchedBy::order;  ///< so far apart
};

/// How far measured yarns lie from simulated ones.
struct Comparison {
    double rms_mm = 0, max_mm = 0;
    std::vector<YarnDeviation> per_yarn;                       ///< in the order of the measured yarns
    std::vector<std::size_t> measured_alone, simulated_alone;  ///< yarns without a partner
    MatchedBy matched_by = MatchedBy::order;
    sim::Alignment alignment;  ///< from the measured axes to those of the simulated cloth
    std::optional<OtherMatching> by_nearness;  ///< where they were matched by order
    std::optional<UnitHint> unit;
};

/// Lays the measured yarns on the simulated ones and measures how far apart they are.
///
/// Alignment is rigid: a rotation and a translation that make the deviations least in the sense of least
/// squares. Cloth axes are left-handed (YARNS.md) and most programs' are not, so each handedness is tried and
/// the other one taken where it fits clearly better. In a periodic cloth a yarn may lie a whole period aside.
/// A deviation is the distance of a measured place from the nearest place of the simulated curve, and counts
/// as much as the length of curve that the place stands for (half way to each neighbour); so it does not
/// matter how either is cut into points, nor which way a yarn was followed. A yarn of more than 4,096 places
/// is cut evenly into so many. Matching by nearness needs the two to have their axes along one another to
/// begin with. Errors: no yarn to compare, too many for nearness.
///
/// Yarns are matched by name where the measured ones have names, else by order where there are as many, else
/// by nearness; `match` asks for order or nearness. Where they lie further apart than a tenth of a radius it
/// is tried whether another matching or another unit fits far better: less than half as far apart.
Result<Comparison> compare(const Yarns& yarns, const MeasuredCloth& measured,
                           std::optional<MatchedBy> match = {});

}  // namespace weave
