#include <weave/sim/inspect.hpp>
#include <weave/sim/inspect_detail.hpp>

#include <algorithm>
#include <limits>
#include <set>

namespace weave {

namespace {

using sim::InspectionSubject;
using sim::Strand;

/// Places looked at on each segment: a cubic between two crossings has its summit near one of them.
constexpr int looks_a_segment = 4;

double thickness_mm(const Yarns& yarns) {
    double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
    for (const SimulatedYarn& yarn : yarns.yarns) {
        const std::size_t looks = looks_a_segment * yarn.spline.segments();
        for (std::size_t k = 0; k <= looks; ++k) {
            const double z = yarn.spline.place(static_cast<double>(k) / looks_a_segment).z();
            low = std::min(low, z - yarn.radius_mm);
            high = std::max(high, z + yarn.radius_mm);
        }
    }
    return std::max(0.0, high - low);
}

std::vector<std::vector<YarnNumber>> sheets_in(const InspectionSubject& subject) {
    std::set<std::size_t> used;
    for (const Strand& strand : subject.strands) used.insert(strand.sheet);
    std::vector<std::vector<YarnNumber>> sheets(used.size());
    for (const Strand& strand : subject.strands) {
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

std::size_t how_many(const InspectionSubject& subject, System system) {
    std::set<std::size_t> numbers;
    for (const Strand& strand : subject.strands) {
        if (strand.system == system) numbers.insert(strand.number);
    }
    return numbers.size();
}

}  // namespace

Result<Inspection> inspect(const Yarns& yarns) {
    WEAVE_TRY(auto places, sim::crossing_places(yarns));
    WEAVE_TRY(const auto order_subject, sim::order_subject(yarns));
    const sim::CrossingOrder order = sim::crossing_order(yarns.crossings, order_subject);
    auto strands = sim::strands_of(yarns, places);
    const InspectionSubject subject{yarns, std::move(places), std::move(strands)};
    Inspection inspection;
    inspection.picks = how_many(subject, System::weft);
    inspection.ends = how_many(subject, System::warp);
    inspection.thickness_mm = yarns.yarns.empty() ? 0 : thickness_mm(yarns);
    inspection.sheets = sheets_in(subject);
    inspection.changed = changed_of(order.lost);
    inspection.slid = changed_of(order.slid);
    sim::find_lengths(subject, inspection);
    sim::find_moved(subject, inspection);
    sim::find_layers(subject, inspection);
    sim::find_jammed(subject, inspection);
    return inspection;
}

}  // namespace weave
