#pragma once

// Shared by the sources of inspect(); no part of the library's face.

#include <weave/sim/inspect.hpp>
#include <weave/sim/strands.hpp>

#include <vector>

namespace weave::sim {

/// A stretch of a yarn's parameter that is measured.
struct MeasuredStretch {
    std::size_t yarn = 0;  ///< index into Yarns::yarns
    double from = 0, to = 0;
};

/// What every part of the inspection looks at, worked out once.
struct InspectionSubject {
    const Yarns& yarns;
    std::vector<CrossingPlace> places;  ///< of each crossing
    std::vector<Strand> strands;        ///< at their crossings away from frozen rims
    std::array<bool, 2> frozen_rims{};  ///< across x and y

    [[nodiscard]] const SimulatedYarn& yarn_of(const Strand& strand) const {
        return yarns.yarns[strand.yarn];
    }
    [[nodiscard]] double width_mm(const Strand& strand) const { return 2 * yarn_of(strand).radius_mm; }
};

/// The direction in the cloth's plane across yarns of a system: x for picks, y for ends.
inline int across(System system) {
    return system == System::weft ? 0 : 1;
}

/// Which part of the cloth this is.
InspectedPart piece_of(const Yarns& yarns);

/// Whether the rims across x and y were held as planned: those of a part, and those that the report calls
/// frozen.
std::array<bool, 2> frozen_rims(const Yarns& yarns);

/// For each crossing whether it lies away from every frozen rim.
std::vector<char> undisturbed(const Yarns& yarns, const std::vector<CrossingPlace>& places,
                              const std::array<bool, 2>& frozen);

/// What is measured of the yarns: all of them, or where a rim is frozen the stretch of each strand between
/// its outermost crossings, if that is long enough.
std::vector<MeasuredStretch> measured_stretches(const InspectionSubject& subject);

void find_lengths(const InspectionSubject& subject, Inspection& inspection);  ///< take-up, beams, crimp
void find_moved(const InspectionSubject& subject, Inspection& inspection);    ///< moved, settled
void find_layers(const InspectionSubject& subject, Inspection& inspection);   ///< leaning, bunched
void find_jammed(const InspectionSubject& subject, Inspection& inspection);   ///< jammed

}  // namespace weave::sim
