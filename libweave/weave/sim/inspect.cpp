#include <weave/sim/inspect.hpp>

#include <weave/sim/inspect_detail.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace weave {

namespace {

using sim::InspectionSubject;
using sim::Strand;

/// Places looked at on each segment: a cubic between two crossings has its summit near one of them.
constexpr int looks_a_segment = 4;

std::optional<double> thickness_mm(const InspectionSubject& subject) {
    double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
    const std::vector<sim::MeasuredStretch> stretches = sim::measured_stretches(subject);
    for (const sim::MeasuredStretch& stretch : stretches) {
        const SimulatedYarn& yarn = subject.yarns.yarns[stretch.yarn];
        const auto looks = static_cast<std::size_t>(std::ceil(looks_a_segment * (stretch.to - stretch.from)));
        for (std::size_t k = 0; k <= looks; ++k) {
            const double z =
                yarn.spline
                    .place(std::min(stretch.to, stretch.from + static_cast<double>(k) / looks_a_segment))
                    .z();
            low = std::min(low, z - yarn.radius_mm);
            high = std::max(high, z + yarn.radius_mm);
        }
    }
    return stretches.empty() ? std::nullopt : std::optional(std::max(0.0, high - low));
}

std::vector<std::vector<YarnNumber>> sheets_in(const std::vector<Strand>& strands) {
    std::set<std::size_t> used;
    for (const Strand& strand : strands) used.insert(strand.sheet);
    std::vector<std::vector<YarnNumber>> sheets(used.size());
    for (const Strand& strand : strands) {
        const auto at = static_cast<std::size_t>(std::distance(used.begin(), used.find(strand.sheet)));
        const YarnNumber yarn{strand.system, strand.number};
        if (sheets[at].empty() || sheets[at].back() != yarn) sheets[at].push_back(yarn);
    }
    return sheets;
}

std::vector<ChangedCrossing> changed_of(const std::vector<sim::LostCrossing>& crossings) {
    std::vector<ChangedCrossing> changed;
    for (const auto& [crossing, found] : crossings)
        changed.push_back({crossing.pick, crossing.end, crossing.weft_over, found});
    return changed;
}

std::size_t how_many(const std::vector<Strand>& strands, System system) {
    std::set<std::size_t> numbers;
    for (const Strand& strand : strands) {
        if (strand.system == system) numbers.insert(strand.number);
    }
    return numbers.size();
}

}  // namespace

Result<Inspection> inspect(const Yarns& yarns) {
    WEAVE_TRY(auto places, sim::crossing_places(yarns));
    WEAVE_TRY(const auto order_subject, sim::order_subject(yarns));
    const sim::CrossingOrder order = sim::crossing_order(yarns.crossings, order_subject);
    const std::vector<Strand> all = sim::strands_of(yarns, places);
    const std::array<bool, 2> frozen = sim::frozen_rims(yarns);
    auto strands = sim::strands_of(yarns, places, sim::undisturbed(yarns, places, frozen));
    const InspectionSubject subject{yarns, std::move(places), std::move(strands), frozen};
    Inspection inspection;
    inspection.part = sim::piece_of(yarns);
    inspection.frozen_rims = frozen;
    inspection.picks = how_many(all, System::weft);
    inspection.ends = how_many(all, System::warp);
    inspection.measured_picks = how_many(subject.strands, System::weft);
    inspection.measured_ends = how_many(subject.strands, System::warp);
    inspection.thickness_mm = thickness_mm(subject);
    inspection.sheets = sheets_in(all);
    inspection.changed = changed_of(order.lost);
    inspection.slid = changed_of(order.slid);
    sim::find_lengths(subject, inspection);
    sim::find_moved(subject, inspection);
    sim::find_layers(subject, inspection);
    sim::find_jammed(subject, inspection);
    return inspection;
}

}  // namespace weave
