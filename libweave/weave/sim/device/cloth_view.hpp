#pragma once

#include <weave/sim/device/view.hpp>
#include <weave/sim/fabric.hpp>
#include <weave/sim/fields.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace weave::sim {

/// What a sample's place is counted in: double, or whole steps of SampleScale::step_mm where forces are float. Differences of such
/// places are exact wherever in the cloth they lie, which those of float places are not (a metre of cloth in float: 60 nm; in
/// steps: below 1 nm).
template <class Real>
using Coordinate = std::conditional_t<std::is_same_v<Real, float>, std::int32_t, Real>;

/// How places are counted: (place - origin) / step_mm.
struct SampleScale {
    double origin[3]{0, 0, 0};
    double step_mm = 1;
};

/// A contact sample: its place in steps, and √k times the arc length that it stands for.
template <class Real>
struct alignas(4 * sizeof(Real)) Sample {
    Coordinate<Real> at[3];
    Real weight;
};

/// The place of `a` less that of `b`, mm.
template <class Real>
WEAVE_HD inline Vec<Real> apart(const Sample<Real>& a, const Sample<Real>& b, Real step_mm) {
    if constexpr (std::is_same_v<Real, float>) {
        const auto less = [](std::int32_t p, std::int32_t q) {
            return static_cast<float>(static_cast<std::int32_t>(static_cast<std::uint32_t>(p) - static_cast<std::uint32_t>(q)));
        };
        return {step_mm * less(a.at[0], b.at[0]), step_mm * less(a.at[1], b.at[1]), step_mm * less(a.at[2], b.at[2])};
    } else {
        return {a.at[0] - b.at[0], a.at[1] - b.at[1], a.at[2] - b.at[2]};
    }
}

/// A place along one axis in steps. What lies beyond all that can be counted counts as lying at its edge.
template <class Real>
WEAVE_HD inline Coordinate<Real> counted(double place_mm, double origin_mm, double step_mm) {
    if constexpr (std::is_same_v<Real, float>) {
        constexpr double edge = 1 << 30;
        const double steps = (place_mm - origin_mm) / step_mm;
        return static_cast<std::int32_t>(steps > edge ? edge : steps < -edge ? -edge : rint(steps));
    } else {
        return place_mm;
    }
}

/// What a slot's movement is made of: weight[k] times that of row[k]. A slot that is a control point and moves is its own row;
/// of one that does not move both weights are 0. A row that does not count is 0.
struct SlotShares {
    std::uint32_t row[2];
    float weight[2];  ///< 1, 2, -1 or 0: exact
};

/// A slot that a row moves.
struct RowSlot {
    std::uint32_t slot;
    float weight;
};

/// Where a yarn's data lies, and how it closes.
struct YarnSpan {
    std::uint32_t first_slot, first_segment, segments, first_row, rows;
    std::uint32_t radius_class;
    std::int32_t turns[2];  ///< periods in x and y from its end to its next beginning
    bool is_periodic;
};

/// The yarns of a scene, as bodies on any machine read them; nothing here changes while they relax.
template <class Real>
struct ClothView {
    std::uint32_t slots = 0, rows = 0, segments = 0, samples = 0, yarns = 0;
    View<const SegmentPlace> segment;
    View<const YarnConstants<Real>> yarn;
    View<const YarnSpan> span;                   ///< per yarn
    View<const Basis<Real>> basis;
    View<const Gauss<Real>> gauss;               ///< one
    View<const std::uint32_t> segment_of_sample;
    View<const std::uint32_t> yarn_of_slot, yarn_of_row, slot_of_row;
    View<const SlotShares> shares;               ///< per slot
    View<const std::uint32_t> first_slot_of_row; ///< per row, and one more
    View<const RowSlot> slots_of_row;
    View<const Sphere<Real>> spheres;
    std::uint32_t fields = 0;
    View<const double> weight_N;                 ///< per yarn: of one segment; none without gravity
    double period_mm[2]{0, 0};                   ///< 0 along an axis that is not periodic
    SampleScale scale;
    Real floor = 0;                              ///< see FabricView
    double least_reach_mm = 0;                   ///< smallest sum of two radii
    double greatest_radius_mm = 0;
    std::uint32_t classes = 0;                   ///< of radii
    View<const double> class_radius_mm;          ///< greatest of each
};

/// A state is 3 numbers a slot, mm, in double; a vector of changes, forces and so on 3 numbers a row, one row for each control
/// point that moves.
using StateView = View<double>;
template <class Real>
using RowsView = View<Real>;

/// The four slots of a segment as they lie around the first of them, mm: of what only asks for differences nothing is lost in
/// float.
template <class Real>
WEAVE_HD inline void load_around_first(const View<const double>& state, std::uint32_t first_slot, Real (&slots)[12]) {
    const double* at = state.at(3 * std::size_t(first_slot), 12);
    for (int c = 0; c < 4; ++c) {
        for (int k = 0; k < 3; ++k) slots[3 * c + k] = static_cast<Real>(at[3 * c + k] - at[k]);
    }
}

/// How a slot moves where rows move.
template <class Real>
WEAVE_HD inline Vec<Real> movement_of(const ClothView<Real>& cloth, const View<const Real>& rows, std::size_t slot) {
    const SlotShares& shares = cloth.shares[slot];
    Vec<Real> sum = Vec<Real>::Zero();
    for (int k = 0; k < 2; ++k) {
        if (shares.weight[k] != 0) sum += Real(shares.weight[k]) * load(rows.at(3 * std::size_t(shares.row[k]), 3));
    }
    return sum;
}

}  // namespace weave::sim
