// Which centrelines come near to one another: segments are sorted into the cells of a grid, and only those in
// one cell are compared. In a periodic direction the cells repeat: a segment is entered in the cell of the
// first repeat that it falls on, with the number of the repeat in which it really lies.

#include <weave/curve/meeting.hpp>

#include <weave/curve/nearness.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>

namespace weave {

namespace {

struct Segment {
    std::size_t yarn = 0, index = 0;
    CubicPiece piece;
    Vec3 low, high;  ///< box round it
};

using Cell = std::array<std::int64_t, 3>;

/// One segment in one cell of the first repeat, and the repeat in which that cell lies.
struct Entry {
    std::uint32_t segment = 0;
    std::array<std::int32_t, 2> repeat{};
};

/// The curves with what their comparison needs.
class Segments {
  public:
    Segments(const ClothCurves& curves, double least_mm) : m_curves(curves), m_least(least_mm) {
        for (std::size_t yarn = 0; yarn < curves.yarns.size(); ++yarn) add(yarn);
        if (m_segments.empty()) return;
        lay_grid();
        enter();
    }

    /// Calls visit(a, b, b's piece moved to where it lies) for every pair whose boxes come close enough.
    template <class Visit>
    void each_pair(Visit visit) const {
        for (std::size_t cell = 0; cell + 1 < m_first.size(); ++cell) {
            for (std::size_t i = m_first[cell]; i < m_first[cell + 1]; ++i) {
                for (std::size_t j = m_first[cell]; j < i; ++j)
                    compare(cell, m_entries[i], m_entries[j], visit);
            }
        }
    }

  private:
    void add(std::size_t yarn) {
        const Spline spline = spline_of(m_curves.yarns[yarn]);
        for (std::size_t k = 0; k < spline.segments(); ++k) add(yarn, k, bezier(spline, k));
        if (spline.segments() > 0 || spline.control.empty()) return;
        const Vec3& point = spline.control.front();  // cut down to one stack
        add(yarn, 0, {point, point, point, point});
    }

    void add(std::size_t yarn, std::size_t index, const CubicPiece& piece) {
        Segment segment{yarn, index, piece, piece[0], piece[0]};
        for (const Vec3& point : piece) {
            segment.low = segment.low.cwiseMin(point);
            segment.high = segment.high.cwiseMax(point);
        }
        segment.low.array() -= m_least / 2;
        segment.high.array() += m_least / 2;
        m_segments.push_back(std::move(segment));
    }

    /// Cells as large as a mean segment, but no more of them than a few times the segments.
    void lay_grid() {
        Vec3 low = m_segments.front().low, high = m_segments.front().high, mean = Vec3::Zero();
        for (const Segment& s : m_segments) {
            low = low.cwiseMin(s.low);
            high = high.cwiseMax(s.high);
            mean += s.high - s.low;
        }
        const double side = std::max((mean / static_cast<double>(m_segments.size())).maxCoeff(), 1e-9);
        m_origin = low;
        const double most = 4 * static_cast<double>(m_segments.size()) + 64;
        Vec3 length = high - low;
        for (const int d : {0, 1}) {
            if (is_periodic(d)) length[d] = period(d);
        }
        Vec3 count = (length / side).array().floor().max(1.0);
        for (double growth = 1.25; count.prod() > most; growth *= 1.25) {
            count = (length / (side * growth)).array().floor().max(1.0);
        }
        for (int d = 0; d < 3; ++d) {
            m_count[static_cast<std::size_t>(d)] = static_cast<std::int64_t>(count[d]);
            m_side[d] = std::max(length[d] / count[d], 1e-9);
        }
    }

    bool is_periodic(int d) const { return d < 2 && m_curves.is_periodic[static_cast<std::size_t>(d)]; }
    double period(int d) const { return m_curves.size_mm[static_cast<std::size_t>(d)]; }

    std::int64_t cell_at(double place, int d) const {
        const auto cell = static_cast<std::int64_t>(std::floor((place - m_origin[d]) / m_side[d]));
        return is_periodic(d) ? cell
                              : std::clamp(cell, std::int64_t{0}, m_count[static_cast<std::size_t>(d)] - 1);
    }

    /// The cell of the first repeat, and the repeat, of a cell.
    std::pair<std::size_t, std::array<std::int32_t, 2>> wrapped(Cell cell) const {
        std::array<std::int32_t, 2> repeat{};
        for (std::size_t d = 0; d < 2; ++d) {
            const std::int64_t n = m_count[d];
            const std::int64_t round = cell[d] >= 0 ? cell[d] / n : -((n - 1 - cell[d]) / n);
            repeat[d] = static_cast<std::int32_t>(round);
            cell[d] -= round * n;
        }
        return {static_cast<std::size_t>((cell[0] * m_count[1] + cell[1]) * m_count[2] + cell[2]), repeat};
    }

    template <class Enter>
    void each_cell(const Segment& s, Enter enter) const {
        Cell low{}, high{}, cell{};
        for (int d = 0; d < 3; ++d) {
            low[static_cast<std::size_t>(d)] = cell_at(s.low[d], d);
            high[static_cast<std::size_t>(d)] = cell_at(s.high[d], d);
        }
        for (cell[0] = low[0]; cell[0] <= high[0]; ++cell[0]) {
            for (cell[1] = low[1]; cell[1] <= high[1]; ++cell[1]) {
                for (cell[2] = low[2]; cell[2] <= high[2]; ++cell[2]) enter(wrapped(cell));
            }
        }
    }

    /// Entries sorted by cell: first counted, then filled in.
    void enter() {
        m_first.assign(static_cast<std::size_t>(m_count[0] * m_count[1] * m_count[2]) + 1, 0);
        for (const Segment& s : m_segments) each_cell(s, [&](const auto& at) { ++m_first[at.first + 1]; });
        for (std::size_t k = 1; k < m_first.size(); ++k) m_first[k] += m_first[k - 1];
        m_entries.resize(m_first.back());
        std::vector<std::size_t> next(m_first.begin(), m_first.end() - 1);
        for (std::size_t k = 0; k < m_segments.size(); ++k) {
            each_cell(m_segments[k], [&](const auto& at) {
                m_entries[next[at.first]++] = {static_cast<std::uint32_t>(k), at.second};
            });
        }
    }

    template <class Visit>
    void compare(std::size_t cell, const Entry& one, const Entry& two, Visit& visit) const {
        const Segment &a = m_segments[one.segment], &b = m_segments[two.segment];
        const std::array<std::int32_t, 2> repeats{one.repeat[0] - two.repeat[0],
                                                  one.repeat[1] - two.repeat[1]};
        const Vec3 moved{is_periodic(0) ? repeats[0] * period(0) : 0,
                         is_periodic(1) ? repeats[1] * period(1) : 0, 0};
        const Vec3 low = a.low.cwiseMax(b.low + moved), high = a.high.cwiseMin(b.high + moved);
        if ((low.array() > high.array()).any()) return;
        if (first_common_cell(a, b, repeats) != std::pair(cell, one.repeat)) return;
        if (follow_one_another(a, b, repeats)) return;
        CubicPiece there = b.piece;
        for (Vec3& point : there) point += moved;
        visit(a, b, there);
    }

    /// A pair that shares several cells is compared in the first. In whole cells, as rounding could make the
    /// two disagree on a boundary.
    std::pair<std::size_t, std::array<std::int32_t, 2>> first_common_cell(
        const Segment& a, const Segment& b, const std::array<std::int32_t, 2>& repeats) const {
        Cell cell{};
        for (std::size_t d = 0; d < 3; ++d) {
            const int axis = static_cast<int>(d);
            const std::int64_t moved = d < 2 ? repeats[d] * m_count[d] : 0;
            cell[d] = std::max(cell_at(a.low[axis], axis), cell_at(b.low[axis], axis) + moved);
        }
        return wrapped(cell);
    }

    /// Whether b, so many repeats away, is on the same yarn as a and next to it (or is a itself).
    bool follow_one_another(const Segment& a, const Segment& b,
                            const std::array<std::int32_t, 2>& repeats) const {
        if (a.yarn != b.yarn) return false;
        const YarnCurve& yarn = m_curves.yarns[a.yarn];
        const auto n = static_cast<std::int64_t>(yarn.keys.size());
        std::int64_t index = static_cast<std::int64_t>(b.index);
        const std::size_t along = yarn.shift.x() != 0 ? 0 : 1;
        if (repeats[1 - along] != 0 || (!yarn.is_periodic && repeats[along] != 0)) return false;
        if (yarn.is_periodic) index += n * repeats[along];
        return std::abs(static_cast<std::int64_t>(a.index) - index) <= 1;
    }

    const ClothCurves& m_curves;
    double m_least;
    std::vector<Segment> m_segments;
    Vec3 m_origin{0, 0, 0}, m_side{1, 1, 1};
    Cell m_count{1, 1, 1};
    std::vector<std::size_t> m_first;  ///< of each cell its first entry
    std::vector<Entry> m_entries;
};

Meeting meeting_of(const Segment& a, const Segment& b, const Nearness& near) {
    return {a.yarn, b.yarn, near.place, near.distance};
}

}  // namespace

Spline spline_of(const YarnCurve& curve) {
    std::vector<Vec3> places;
    places.reserve(curve.keys.size());
    for (const KeyPoint& key : curve.keys) places.push_back(key.place);
    return interpolate(places, curve.is_periodic, curve.shift);
}

std::vector<CloseSegments> close_segments(const ClothCurves& curves, double least_mm) {
    std::vector<CloseSegments> found;
    Segments(curves, least_mm).each_pair([&](const Segment& a, const Segment& b, const CubicPiece& there) {
        Nearness near{least_mm, Vec3::Zero()};
        if (bring_nearer(a.piece, there, near)) found.push_back({meeting_of(a, b, near), a.index, b.index});
    });
    return found;
}

std::optional<Meeting> first_meeting(const ClothCurves& curves, double least_mm) {
    std::optional<Meeting> first;
    Nearness near{least_mm, Vec3::Zero()};
    Segments(curves, least_mm).each_pair([&](const Segment& a, const Segment& b, const CubicPiece& there) {
        if (bring_nearer(a.piece, there, near)) first = meeting_of(a, b, near);
    });
    if (first && first->yarn > first->other) std::swap(first->yarn, first->other);
    return first;
}

}  // namespace weave
