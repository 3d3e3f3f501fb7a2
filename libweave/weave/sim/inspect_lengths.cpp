// How much yarn goes into the cloth: take-up and crimp.

#include <weave/sim/inspect_detail.hpp>
#include <weave/sim/take_up.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace weave::sim {

namespace {

/// Length of a centreline seen from above, along its control points' places.
double length_from_above(const Spline& spline) {
    double length = 0;
    Vec3 last = spline.place(0);
    for (std::size_t i = 1; i <= spline.segments(); ++i) {
        const Vec3 next = spline.place(static_cast<double>(i));
        length += std::hypot(next.x() - last.x(), next.y() - last.y());
        last = next;
    }
    return length;
}

/// Length of a centreline between two parameters, by chords: to a ten-thousandth where it bends to its own
/// width.
double length_between(const Spline& spline, double from, double to) {
    constexpr double chords_a_segment = 16;
    const auto chords = std::max(1.0, std::ceil(chords_a_segment * (to - from)));
    double length = 0;
    Vec3 last = spline.place(from);
    for (double k = 1; k <= chords; ++k) {
        const Vec3 next = spline.place(from + (to - from) * k / chords);
        length += (next - last).norm();
        last = next;
    }
    return length;
}

/// Crimp of a yarn. One of several picks goes there and back, so of that the planned way as seen from above
/// counts.
double crimp_of(const SimulatedYarn& yarn, bool several_picks) {
    if (!several_picks) return take_up_of(yarn);
    const double way = length_from_above({yarn.planned, yarn.spline.is_periodic, yarn.spline.shift});
    return way > 0 ? (yarn.length_mm - way) / way : 0;
}

/// Crimp of each yarn away from frozen rims: of its measured stretches together, each against the straight
/// way seen from above. Nothing where a yarn has none.
std::vector<std::optional<double>> crimps_inside(const InspectionSubject& subject) {
    std::vector<double> lengths(subject.yarns.yarns.size(), 0), ways = lengths;
    for (const auto& [yarn, from, to] : measured_stretches(subject)) {
        const Spline& spline = subject.yarns.yarns[yarn].spline;
        const Vec3 apart = spline.place(to) - spline.place(from);
        lengths[yarn] += length_between(spline, from, to);
        ways[yarn] += std::hypot(apart.x(), apart.y());
    }
    std::vector<std::optional<double>> crimps(lengths.size());
    for (std::size_t y = 0; y < crimps.size(); ++y) {
        if (ways[y] > 0) crimps[y] = lengths[y] / ways[y] - 1;
    }
    return crimps;
}

std::vector<std::optional<double>> crimps_of(const InspectionSubject& subject) {
    if (subject.frozen_rims[0] || subject.frozen_rims[1]) return crimps_inside(subject);
    std::vector<std::size_t> strands_in(subject.yarns.yarns.size(), 0);
    for (const Strand& strand : subject.strands) ++strands_in[strand.yarn];
    std::vector<std::optional<double>> crimps;
    for (std::size_t y = 0; y < strands_in.size(); ++y) {
        const SimulatedYarn& yarn = subject.yarns.yarns[y];
        crimps.emplace_back(crimp_of(yarn, yarn.system == System::weft && strands_in[y] > 1));
    }
    return crimps;
}

class SpreadMaker {
  public:
    void add(double value, std::size_t of) {
        if (m_count == 0 || value < m_spread.least) m_spread.least = value, m_spread.least_of = of;
        if (m_count == 0 || value > m_spread.most) m_spread.most = value, m_spread.most_of = of;
        m_sum += value;
        ++m_count;
    }
    [[nodiscard]] std::size_t count() const { return m_count; }
    [[nodiscard]] Spread spread() const {
        Spread spread = m_spread;
        spread.mean = m_sum / static_cast<double>(std::max<std::size_t>(m_count, 1));
        return spread;
    }
    [[nodiscard]] std::optional<Spread> if_any() const {
        return m_count == 0 ? std::nullopt : std::optional<Spread>(spread());
    }

  private:
    Spread m_spread;
    double m_sum = 0;
    std::size_t m_count = 0;
};

/// Where the least of all rotations of a list begins (two candidates run against each other, linear).
std::size_t least_rotation(const std::vector<std::size_t>& list) {
    const std::size_t n = list.size();
    std::size_t a = 0, b = 1, same = 0;
    while (a < n && b < n && same < n) {
        const std::size_t x = list[(a + same) % n], y = list[(b + same) % n];
        if (x == y) {
            ++same;
            continue;
        }
        (x > y ? a : b) += same + 1;
        if (a == b) ++b;
        same = 0;
    }
    return std::min(a, b);
}

/// Numbers courses through the picks, so that ends of equal course get equal numbers.
class Courses {
  public:
    explicit Courses(const InspectionSubject& subject) : m_subject(subject) {}

    /// Of an end: row by row which picks lie above and below it and how thick they are. Where it repeats it
    /// counts from whichever row.
    std::size_t number(const Strand& strand) {
        std::vector<std::size_t> course;
        std::vector<double> row;
        const auto& crossings = m_subject.yarns.crossings;
        for (std::size_t k = 0; k < strand.crossings.size(); ++k) {
            const Crossing& crossing = crossings[strand.crossings[k]];
            const double radius = m_subject.yarns.yarns[crossing.weft].radius_mm;
            row.push_back(crossing.weft_over ? radius : -radius);
            const bool last = k + 1 == strand.crossings.size() ||
                              crossings[strand.crossings[k + 1]].warp_key != crossing.warp_key;
            if (!last) continue;
            course.push_back(m_rows.emplace(row, m_rows.size()).first->second);
            row.clear();
        }
        if (m_subject.yarn_of(strand).spline.is_periodic)
            std::rotate(course.begin(), course.begin() + static_cast<std::ptrdiff_t>(least_rotation(course)), course.end());
        return m_courses.emplace(course, m_courses.size()).first->second;
    }

  private:
    const InspectionSubject& m_subject;
    std::map<std::vector<double>, std::size_t> m_rows;
    std::map<std::vector<std::size_t>, std::size_t> m_courses;
};

void find_alike(const std::map<std::tuple<std::uint32_t, double, std::size_t>, SpreadMaker>& alike,
                BeamTakeUp& beam) {
    for (const auto& [key, maker] : alike) {
        if (std::get<0>(key) != beam.beam || maker.count() < 2) continue;
        const Spread spread = maker.spread();
        if (beam.alike && spread.most - spread.least <= *beam.alike) continue;
        beam.alike = spread.most - spread.least;
        beam.alike_least_of = spread.least_of;
        beam.alike_most_of = spread.most_of;
    }
}

}  // namespace

void find_lengths(const InspectionSubject& subject, Inspection& inspection) {
    const std::vector<std::optional<double>> crimps = crimps_of(subject);
    SpreadMaker warp, weft;
    std::map<std::uint32_t, SpreadMaker> beams;
    std::map<std::tuple<std::uint32_t, double, std::size_t>, SpreadMaker> alike;
    std::vector<const Strand*> strand_of(subject.yarns.yarns.size(), nullptr);
    for (const Strand& strand : subject.strands) strand_of[strand.yarn] = &strand;
    Courses courses(subject);
    for (std::size_t y = 0; y < subject.yarns.yarns.size(); ++y) {
        const SimulatedYarn& yarn = subject.yarns.yarns[y];
        if (!crimps[y]) continue;
        const double crimp = *crimps[y];
        (yarn.system == System::warp ? warp : weft).add(crimp, yarn.number);
        if (yarn.system != System::warp) continue;
        inspection.take_up.push_back({yarn.number, yarn.beam, crimp});
        beams[yarn.beam].add(crimp, yarn.number);
        if (strand_of[y] != nullptr)
            alike[{yarn.beam, yarn.radius_mm, courses.number(*strand_of[y])}].add(crimp, yarn.number);
    }
    std::ranges::sort(inspection.take_up, {}, &EndTakeUp::end);
    inspection.warp_crimp = warp.if_any();
    inspection.weft_crimp = weft.if_any();
    for (const auto& [beam, maker] : beams) {
        inspection.beams.push_back({beam, maker.count(), maker.spread(), {}, 0, 0});
        find_alike(alike, inspection.beams.back());
    }
}

}  // namespace weave::sim
