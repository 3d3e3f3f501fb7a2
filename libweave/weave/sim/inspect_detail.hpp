#pragma once

// Shared by the sources of inspect(); no part of the library's face.

#include <weave/sim/inspect.hpp>
#include <weave/sim/strands.hpp>

#include <vector>

namespace weave::sim {

/// What every part of the inspection looks at, worked out once.
struct InspectionSubject {
    const Yarns& yarns;
    std::vector<CrossingPlace> places;  ///< of each crossing
    std::vector<Strand> strands;

    [[nodiscard]] const SimulatedYarn& yarn_of(const Strand& strand) const {
        return yarns.yarns[strand.yarn];
    }
    [[nodiscard]] double width_mm(const Strand& strand) const { return 2 * yarn_of(strand).radius_mm; }
};

/// The direction in the cloth's plane across yarns of a system: x for picks, y for ends.
inline int across(System system) {
    return system == System::weft ? 0 : 1;
}

void find_lengths(const InspectionSubject& subject, Inspection& inspection);  ///< take-up, beams, crimp
void find_moved(const InspectionSubject& subject, Inspection& inspection);    ///< moved, settled
void find_layers(const InspectionSubject& subject, Inspection& inspection);   ///< leaning, bunched
void find_jammed(const InspectionSubject& subject, Inspection& inspection);   ///< jammed

}  // namespace weave::sim
