// Yarns that are not where they were planned.

#include <weave/sim/inspect_detail.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace weave::sim {

namespace {

/// How a sheet settles as a whole: at height z every place has moved by a + b (z - middle), along each axis
/// on the mean of its crossings.
class Settling {
  public:
    void add(const Vec3& planned, const Vec3& moved) {
        ++m_count;
        const double step = planned.z() - m_middle;
        const Vec3 change = moved - m_mean;
        m_middle += step / m_count;
        m_mean += change / m_count;
        m_square += step * (planned.z() - m_middle);
        m_product += change * (planned.z() - m_middle);
    }
    /// In a direction that does not repeat the rims hold the cloth in its place, so nothing is taken off.
    void finish(const std::array<bool, 2>& is_periodic) {
        m_slope = m_square > 1e-12 ? Vec3(m_product / m_square) : Vec3(0, 0, 0);
        for (int axis = 0; axis < 2; ++axis) {
            if (!is_periodic[static_cast<std::size_t>(axis)]) m_mean[axis] = m_slope[axis] = 0;
        }
    }
    [[nodiscard]] Vec3 at(const Vec3& planned) const { return m_mean + m_slope * (planned.z() - m_middle); }
    /// Sum of squares of planned heights about their middle: how thick it is and how much there is of it.
    [[nodiscard]] double weight() const { return m_square; }
    [[nodiscard]] double height_share() const { return 1 + m_slope.z(); }

  private:
    double m_count = 0, m_middle = 0, m_square = 0;
    Vec3 m_mean{0, 0, 0}, m_product{0, 0, 0}, m_slope{0, 0, 0};
};

struct Movement {
    Vec3 planned, moved;
};

Movement movement(const InspectionSubject& subject, const Strand& strand, std::size_t crossing) {
    const CrossingPlace& place = subject.places[crossing];
    if (strand.system == System::warp) return {place.planned_warp, place.warp - place.planned_warp};
    return {place.planned_weft, place.weft - place.planned_weft};
}

std::vector<Settling> settlings(const InspectionSubject& subject) {
    std::size_t sheets = 0;
    for (const Strand& strand : subject.strands) sheets = std::max(sheets, strand.sheet + 1);
    std::vector<Settling> all(sheets);
    for (const Strand& strand : subject.strands) {
        for (const std::size_t crossing : strand.crossings) {
            const Movement move = movement(subject, strand, crossing);
            all[strand.sheet].add(move.planned, move.moved);
        }
    }
    for (Settling& settling : all) settling.finish(subject.yarns.is_periodic);
    return all;
}

}  // namespace

void find_moved(const InspectionSubject& subject, Inspection& inspection) {
    const std::vector<Settling> settled = settlings(subject);
    const auto thickest = std::ranges::max_element(settled, {}, &Settling::weight);
    if (thickest != settled.end()) inspection.settled = thickest->height_share();
    for (const Strand& strand : subject.strands) {
        MovedYarn worst{{strand.system, strand.number}};
        double sum = 0;
        for (const std::size_t crossing : strand.crossings) {
            const Movement move = movement(subject, strand, crossing);
            Vec3 way = move.moved - settled[strand.sheet].at(move.planned);
            way[1 - across(strand.system)] = 0;
            sum += way[across(strand.system)];
            if (way.norm() <= worst.mm) continue;
            worst.mm = way.norm();
            worst.way = way;
            const Crossing& at = subject.yarns.crossings[crossing];
            worst.crossed = strand.system == System::warp ? at.pick : at.end;
        }
        worst.widths = worst.mm / subject.width_mm(strand);
        worst.mean_mm = sum / static_cast<double>(strand.crossings.size());
        if (worst.widths > 1) inspection.moved.push_back(worst);
    }
    std::ranges::stable_sort(inspection.moved, std::greater{}, &MovedYarn::widths);
}

}  // namespace weave::sim
