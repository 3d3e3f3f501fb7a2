#pragma once

// Second derivatives of one segment's energy by its four control slots, as 12 × 12 matrices. Formulas follow from the
// energies in bodies.hpp.

#include <weave/sim/bodies.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>

namespace weave::sim {

/// Second derivatives by four slots and four other slots: block (c, d) lies at 9 (4c + d), column by column.
struct SlotBlocks {
    double block[16][9];

    void clear() { std::fill(&block[0][0], &block[0][0] + 16 * 9, 0.0); }

    /// Adds B_c A_d H to block (c, d).
    void add(const double (&rows)[4], const double (&columns)[4], const Mat<double>& h) {
        const double* from = h.data();
        for (int c = 0; c < 4; ++c) {
            for (int d = 0; d < 4; ++d) {
                const double weight = rows[c] * columns[d];
                double* to = block[4 * c + d];
                for (int k = 0; k < 9; ++k) to[k] += weight * from[k];
            }
        }
    }
};

inline Mat<double> across(const Vec<double>& unit) {
    return Mat<double>::Identity() - unit * unit.transpose();
}

inline void add_stretch_curvature(const YarnConstants<double>& yarn, const Gauss<double>& gauss,
                                  const Speeds<double>& speeds, bool convex, SlotBlocks& sum) {
    const bool fed = yarn.supply == Supply::tension;
    const double length = guarded(speeds.length, yarn), square = speeds.square, ratio = square / (length * length);
    Vec<double> units[gauss_points];
    for (std::size_t g = 0; g < gauss_points; ++g) {
        const double speed = guarded(speeds.speed[g], yarn), weight = gauss.weight[g];
        const Vec<double> unit = speeds.tangent[g] / speed;
        double pull = fed ? yarn.tension_N + yarn.evenness_N * (speed / length - (ratio + 1) / 2)
                          : yarn.stretch_N * (speed / yarn.rest_mm - 1);
        if (convex) pull = std::max(pull, 0.0);
        sum.add(gauss.basis[g].slope, gauss.basis[g].slope, across(unit) * (weight * pull / speed));
        units[g] = unit;
    }
    for (std::size_t g = 0; g < gauss_points; ++g) {
        for (std::size_t h = 0; h < gauss_points; ++h) {
            if (!fed && g != h) continue;
            const double both = gauss.weight[g] * gauss.weight[h], own = g == h ? gauss.weight[g] : 0;
            const double even = own / length - both * (speeds.speed[g] + speeds.speed[h]) / (length * length) +
                                both * square / (length * length * length);
            const double stiffness = fed ? yarn.evenness_N * even : yarn.stretch_N * own / yarn.rest_mm;
            sum.add(gauss.basis[g].slope, gauss.basis[h].slope, stiffness * units[g] * units[h].transpose());
        }
    }
}

/// With T = y', C = y'', N = T × C: e = c |N|² |T|⁻⁵. Convex: twice c times JᵀJ of N |T|^(-5/2).
inline void add_bending_curvature(const YarnConstants<double>& yarn, const Gauss<double>& gauss, const double* slots,
                                  const Speeds<double>& speeds, bool convex, SlotBlocks& sum) {
    const auto cross_with = [](const Vec<double>& v) {
        Mat<double> m;
        m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
        return m;
    };
    for (std::size_t g = 0; g < gauss_points; ++g) {
        const Basis<double>& basis = gauss.basis[g];
        const Vec<double> t = speeds.tangent[g], c = combine(basis.bend, slots);
        const double speed = guarded(speeds.speed[g], yarn), v2 = speed * speed;
        const double scale = gauss.weight[g] * yarn.bending / (2 * v2 * v2 * speed);
        const Vec<double> normal = t.cross(c);
        Mat<double> tt, tc, cc;
        if (convex) {
            const Mat<double> by_t = -cross_with(c) - 2.5 / v2 * normal * t.transpose(), by_c = cross_with(t);
            tt = 2 * scale * by_t.transpose() * by_t;
            tc = 2 * scale * by_t.transpose() * by_c;
            cc = 2 * scale * by_c.transpose() * by_c;
        } else {
            const double along = t.dot(c), n2 = normal.squaredNorm(), c2 = c.squaredNorm();
            const Vec<double> by_c = t.squaredNorm() * c - along * t, by_t = c2 * t - along * c;
            cc = 2 * scale * (t.squaredNorm() * Mat<double>::Identity() - t * t.transpose());
            tc = 2 * scale * (2 * t * c.transpose() - along * Mat<double>::Identity() - c * t.transpose()) -
                 10 * scale / v2 * t * by_c.transpose();
            tt = scale * (2 * c2 * Mat<double>::Identity() - 2 * c * c.transpose()) -
                 10 * scale / v2 * (by_t * t.transpose() + t * by_t.transpose()) -
                 5 * scale * n2 / v2 * Mat<double>::Identity() + 35 * scale * n2 / (v2 * v2) * t * t.transpose();
        }
        sum.add(basis.slope, basis.slope, tt);
        sum.add(basis.slope, basis.bend, tc);
        sum.add(basis.bend, basis.slope, tc.transpose());
        sum.add(basis.bend, basis.bend, cc);
    }
}

/// What the second derivatives of one pair of samples are made of.
struct PairCurvature {
    Mat<double> by_place;    ///< ∂²f/∂u∂u, u = y_a - y_b
    Vec<double> slope;       ///< ∂f/∂u
    double value = 0;        ///< f
};

/// `limit` is D². Convex: only along the line that joins the samples.
inline PairCurvature pair_curvature(const Vec<double>& u, double limit, double floor, bool convex) {
    const double square = u.squaredNorm(), s = square / limit;
    const ContactLaw<double> law = ContactLaw<double>::at(s, floor);
    const double side = 2 * law.slope / limit;
    PairCurvature pair;
    pair.value = law.value;
    pair.slope = side * u;
    if (convex) {
        const double along = 2 / limit * std::max(law.slope + 2 * s * law.bend, -law.slope);
        pair.by_place = square > 0 ? Mat<double>(along / square * u * u.transpose()) : Mat<double>(along * Mat<double>::Identity());
    } else {
        pair.by_place = side * Mat<double>::Identity() + 4 * law.bend / (limit * limit) * u * u.transpose();
    }
    return pair;
}

}  // namespace weave::sim
