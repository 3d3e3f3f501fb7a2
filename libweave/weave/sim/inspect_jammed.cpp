// Yarns without room: Peirce's jam.

#include <weave/sim/inspect_detail.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace weave::sim {

namespace {

/// Less room than this share is none.
constexpr double least_room = 0.02;

/// A yarn that is crossed, as a circle in the plane of the yarn that crosses it.
struct Obstacle {
    std::size_t number = 0;
    Vec3 centre{0, 0, 0};
    double reach_mm = 0;  ///< from its centre to that of the yarn that crosses it
};

/// One stack that a yarn passes: what lies next below and next above it.
struct Passage {
    std::optional<Obstacle> below, above;
};

class JamFinder {
  public:
    JamFinder(const InspectionSubject& subject, const Strand& strand) : m_subject(subject), m_strand(strand) {
        m_jammed.yarn = {strand.system, strand.number};
        m_jammed.room = std::numeric_limits<double>::max();
    }

    std::optional<JammedYarn> run(bool whole_yarn) {
        const std::vector<Passage> passages = this->passages();
        for (std::size_t i = 0; i + 1 < passages.size(); ++i)
            change(passages[i], passages[i + 1], Vec3(0, 0, 0));
        const Spline& spline = m_subject.yarn_of(m_strand).spline;
        if (whole_yarn && spline.is_periodic && !passages.empty())
            change(passages.back(), passages.front(), spline.shift);
        return m_jammed.places > 0 ? std::optional<JammedYarn>(m_jammed) : std::nullopt;
    }

  private:
    [[nodiscard]] bool is_warp() const { return m_strand.system == System::warp; }

    [[nodiscard]] std::vector<Passage> passages() const {
        std::vector<Passage> all;
        std::size_t last_key = 0;
        for (const std::size_t i : m_strand.crossings) {
            const Crossing& crossing = m_subject.yarns.crossings[i];
            const auto& spot = m_subject.places[i].spot;
            const std::size_t key = is_warp() ? crossing.warp_key : crossing.weft_key;
            if (all.empty() || key != last_key) all.emplace_back();
            last_key = key;
            if (!spot) continue;
            const SimulatedYarn &weft = m_subject.yarns.yarns[crossing.weft],
                                &warp = m_subject.yarns.yarns[crossing.warp];
            Obstacle met;
            met.number = is_warp() ? crossing.pick : crossing.end;
            met.centre = is_warp() ? weft.spline.place(spot->weft_at) : warp.spline.place(spot->warp_at);
            // Soft yarns press into one another, so what counts is how near they have come.
            met.reach_mm = std::min(weft.radius_mm + warp.radius_mm, std::abs(spot->height_mm));
            auto& [below, above] = all.back();
            const bool is_above = crossing.weft_over == is_warp();
            if (is_above && (!above || met.centre.z() < above->centre.z())) above = met;
            if (!is_above && (!below || met.centre.z() > below->centre.z())) below = met;
        }
        return all;
    }

    void change(const Passage& from, const Passage& to, const Vec3& shift) {
        if (from.below && to.above) squeeze(*from.below, *to.above, shift);
        if (from.above && to.below) squeeze(*from.above, *to.below, shift);
    }

    /// Between two circles on opposite sides of it a yarn has a straight piece as long as they lie further
    /// apart than their radii together.
    void squeeze(const Obstacle& a, const Obstacle& b, const Vec3& shift) {
        const Vec3 apart = b.centre + shift - a.centre;
        const double distance = std::hypot(apart[is_warp() ? 0 : 1], apart.z()),
                     least = a.reach_mm + b.reach_mm;
        if (!(least > 0)) return;
        ++m_jammed.of;
        const double room = distance / least - 1;
        if (room < least_room) ++m_jammed.places;
        if (room >= m_jammed.room) return;
        m_jammed.room = room;
        m_jammed.between = {a.number, b.number};
    }

    const InspectionSubject& m_subject;
    const Strand& m_strand;
    JammedYarn m_jammed;
};

}  // namespace

void find_jammed(const InspectionSubject& subject, Inspection& inspection) {
    std::vector<std::size_t> strands_in(subject.yarns.yarns.size(), 0);
    for (const Strand& strand : subject.strands) ++strands_in[strand.yarn];
    for (const Strand& strand : subject.strands) {
        if (const auto jammed = JamFinder(subject, strand).run(strands_in[strand.yarn] == 1))
            inspection.jammed.push_back(*jammed);
    }
    std::ranges::stable_sort(inspection.jammed, {}, &JammedYarn::room);
}

}  // namespace weave::sim
