#pragma once

// Second derivatives of one segment's energy by its four control slots, as 12 × 12 matrices. Formulas follow from the
// energies in bodies.hpp.

#include <weave/sim/bodies.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>

namespace weave::sim {

/// A 3×3 matrix column by column: plain numbers, which compilers bring into wide vectors better than matrices.
template <class Real>
struct NineOf {
    Real at[9];

    /// a bᵀ
    WEAVE_INLINE WEAVE_HD static NineOf outer(const Vec<Real>& a, const Vec<Real>& b) {
        return {{a[0] * b[0], a[1] * b[0], a[2] * b[0], a[0] * b[1], a[1] * b[1], a[2] * b[1], a[0] * b[2], a[1] * b[2],
                 a[2] * b[2]}};
    }
    /// s I + f a aᵀ
    WEAVE_INLINE WEAVE_HD static NineOf along(Real s, Real f, const Vec<Real>& a) {
        const Real x = f * a[0], y = f * a[1], z = f * a[2];
        return {{s + x * a[0], y * a[0], z * a[0], x * a[1], s + y * a[1], z * a[1], x * a[2], y * a[2], s + z * a[2]}};
    }
    WEAVE_INLINE WEAVE_HD NineOf& operator+=(const NineOf& other) {
        for (int k = 0; k < 9; ++k) at[k] += other.at[k];
        return *this;
    }
    WEAVE_INLINE WEAVE_HD NineOf transposed() const {
        return {{at[0], at[3], at[6], at[1], at[4], at[7], at[2], at[5], at[8]}};
    }
};
using Nine = NineOf<double>;

/// Sums of 3×3 matrices, one for each of four slots that columns belong to, before they are handed to rows: a sum over
/// what one sample meets of another segment then costs four products of matrices instead of sixteen.
struct ColumnBlocks {
    alignas(32) double block[36];

    [[gnu::always_inline]] void clear() {
        for (int k = 0; k < 36; ++k) block[k] = 0;
    }

    /// Adds A_d H to each block d.
    [[gnu::always_inline]] void add(const double (&columns)[4], const Nine& h) {
        for (int d = 0; d < 4; ++d) {
            for (int k = 0; k < 9; ++k) block[9 * d + k] += columns[d] * h.at[k];
        }
    }
    [[gnu::always_inline]] void take(const double (&columns)[4], const Nine& h) {
        for (int d = 0; d < 4; ++d) {
            for (int k = 0; k < 9; ++k) block[9 * d + k] -= columns[d] * h.at[k];
        }
    }
};

/// Second derivatives by four slots and four other slots: block (c, d) lies at 9 (4c + d), column by column.
struct SlotBlocks {
    alignas(32) double block[16 * 9];

    void clear() { std::fill(block, block + 16 * 9, 0.0); }

    /// Columns with the four weights of the rows that they are handed to.
    struct Rows {
        const double* weights;
        const ColumnBlocks* columns;
    };

    /// Adds weight c times each of the columns' blocks to blocks (c, …).
    template <std::size_t N>
    [[gnu::always_inline]] void add(const Rows (&parts)[N]) {
        typedef double Four __attribute__((vector_size(32), may_alias));
        for (int k = 0; k < 36; k += 4) {
            Four sums[4];
            for (int c = 0; c < 4; ++c) sums[c] = *reinterpret_cast<const Four*>(&block[36 * c + k]);
            for (std::size_t n = 0; n < N; ++n) {
                const Four column = *reinterpret_cast<const Four*>(&parts[n].columns->block[k]);
                for (int c = 0; c < 4; ++c) sums[c] += parts[n].weights[c] * column;
            }
            for (int c = 0; c < 4; ++c) *reinterpret_cast<Four*>(&block[36 * c + k]) = sums[c];
        }
    }

    /// Adds B_c A_d H to block (c, d).
    void add(const double (&rows)[4], const double (&columns)[4], const Mat<double>& h) {
        Nine nine;
        for (int k = 0; k < 9; ++k) nine.at[k] = h.data()[k];
        ColumnBlocks by_columns;
        by_columns.clear();
        by_columns.add(columns, nine);
        add({{rows, &by_columns}});
    }
};

template <class Real>
WEAVE_HD inline Mat<Real> across(const Vec<Real>& unit) {
    return Mat<Real>::Identity() - unit * unit.transpose();
}

/// Second derivatives by the slope y' and the bend y'' at each Gauss point of one segment: their rows, by its slots.
struct GaussBlocks {
    ColumnBlocks slope[gauss_points], bend[gauss_points];

    [[gnu::always_inline]] void clear() {
        for (std::size_t g = 0; g < gauss_points; ++g) slope[g].clear(), bend[g].clear();
    }
    [[gnu::always_inline]] void add_to(SlotBlocks& sum, const Gauss<double>& gauss) const {
        sum.add({{gauss.basis[0].slope, &slope[0]}, {gauss.basis[1].slope, &slope[1]},
                     {gauss.basis[2].slope, &slope[2]}, {gauss.basis[3].slope, &slope[3]},
                     {gauss.basis[0].bend, &bend[0]}, {gauss.basis[1].bend, &bend[1]},
                     {gauss.basis[2].bend, &bend[2]}, {gauss.basis[3].bend, &bend[3]}});
    }
};

/// What the second derivative of stretch by the slope y' is made of at one Gauss point: side · I + along · t tᵀ, t being the
/// tangent's unit.
template <class Real>
struct StretchCurvature {
    Real side, along;
};

/// `ratio`: the mean square of the speeds over the square of the segment's length.
template <class Real>
WEAVE_INLINE WEAVE_HD inline StretchCurvature<Real> stretch_curvature(const YarnConstants<Real>& yarn, Real weight, Real speed,
                                                                      Real length, Real ratio, Real give, bool convex) {
    const bool fed = yarn.supply == Supply::tension;
    const StretchLaw<Real> law = StretchLaw<Real>::at(fed ? 0 : speed / yarn.rest_mm - 1, give);
    Real pull = fed ? yarn.tension_N + yarn.evenness_N * (speed / length - (ratio + 1) / 2) : yarn.stretch_N * law.slope;
    if (convex) pull = std::max(pull, Real(0));
    const Real side = weight * pull / speed;
    if (fed) return {side, -side};
    return {side, yarn.stretch_N * law.bend * weight / yarn.rest_mm - side};
}

/// What evenness links, over EA·S: the speeds at Gauss points g and h.
template <class Real>
WEAVE_INLINE WEAVE_HD inline Real evenness_link(const Gauss<Real>& gauss, const Speeds<Real>& speeds, Real length, std::size_t g,
                                                std::size_t h) {
    const Real weight = gauss.weight[g], both = weight * gauss.weight[h], own = g == h ? weight : 0;
    return own / length - both * (speeds.speed[g] + speeds.speed[h]) / (length * length) +
           both * speeds.square / (length * length * length);
}

/// By all four slots. What stretch_curvature() says stands here once more: called from here it rounds otherwise, and results of the
/// processor keep their bits.
[[gnu::always_inline]] inline void add_stretch_curvature(const YarnConstants<double>& yarn, const Gauss<double>& gauss,
                                                         const Speeds<double>& speeds, double give, bool convex,
                                                         GaussBlocks& sum) {
    const bool fed = yarn.supply == Supply::tension;
    const double length = guarded(speeds.length, yarn), ratio = speeds.square / (length * length);
    Vec<double> units[gauss_points];
    for (std::size_t g = 0; g < gauss_points; ++g) units[g] = speeds.tangent[g] / guarded(speeds.speed[g], yarn);
    for (std::size_t g = 0; g < gauss_points; ++g) {
        const double speed = guarded(speeds.speed[g], yarn), weight = gauss.weight[g];
        const StretchLaw<double> law = StretchLaw<double>::at(fed ? 0 : speed / yarn.rest_mm - 1, give);
        double pull = fed ? yarn.tension_N + yarn.evenness_N * (speed / length - (ratio + 1) / 2) : yarn.stretch_N * law.slope;
        if (convex) pull = std::max(pull, 0.0);
        const double side = weight * pull / speed;
        if (!fed) {
            sum.slope[g].add(gauss.basis[g].slope, Nine::along(side, yarn.stretch_N * law.bend * weight / yarn.rest_mm - side, units[g]));
            continue;
        }
        sum.slope[g].add(gauss.basis[g].slope, Nine::along(side, -side, units[g]));
        // What evenness links: the speeds at all Gauss points.
        Vec<double> others[4];
        for (Vec<double>& other : others) other.setZero();
        for (std::size_t h = 0; h < gauss_points; ++h) {
            const double even = evenness_link(gauss, speeds, length, g, h);
            for (int d = 0; d < 4; ++d) others[d] += yarn.evenness_N * even * gauss.basis[h].slope[d] * units[h];
        }
        for (int d = 0; d < 4; ++d) {
            const Nine link = Nine::outer(units[g], others[d]);
            for (int k = 0; k < 9; ++k) sum.slope[g].block[9 * d + k] += link.at[k];
        }
    }
}

/// Second derivatives of bending at one Gauss point, by the slope y' (t) and the bend y'' (c).
template <class Real>
struct BendingCurvature {
    NineOf<Real> tt, tc, cc;
};

/// With T = y', C = y'', N = T × C: e = c |N|² |T|⁻⁵. Convex: twice c times JᵀJ of N |T|^(-5/2). Both come to the same
/// products with other factors, for C × N = |C|² T - (T·C) C and N × T = |T|² C - (T·C) T.
template <class Real>
WEAVE_INLINE WEAVE_HD inline BendingCurvature<Real> bending_curvature(const YarnConstants<Real>& yarn, Real weight, Real speed,
                                                                      const Vec<Real>& t, const Vec<Real>& c, bool convex) {
    const Real v2 = speed * speed;
    const Real two = weight * yarn.bending / (v2 * v2 * speed);  // 2c
    const Real n2 = t.cross(c).squaredNorm(), c2 = c.squaredNorm(), t2 = t.squaredNorm(), along = t.dot(c);
    const Vec<Real> by_t = c2 * t - along * c, by_c = t2 * c - along * t;
    const Real mixed = (convex ? Real(2.5) : Real(5)) * two / v2,
               own = (convex ? Real(6.25) : Real(17.5)) * two * n2 / (v2 * v2), less = convex ? 0 : Real(2.5) * two * n2 / v2;
    BendingCurvature<Real> all{NineOf<Real>::along(two * c2 - less, -two, c),
                               NineOf<Real>::outer(t, (convex ? two : 2 * two) * c - mixed * by_c),
                               NineOf<Real>::along(two * t2, -two, t)};
    all.tt += NineOf<Real>::outer(by_t, -mixed * t);
    all.tt += NineOf<Real>::outer(t, own * t - mixed * by_t);
    for (int k = 0; k < 9; k += 4) all.tc.at[k] -= two * along;
    if (!convex) all.tc += NineOf<Real>::outer(c, -two * t);
    return all;
}

[[gnu::always_inline]] inline void add_bending_curvature(const YarnConstants<double>& yarn, const Gauss<double>& gauss,
                                                         const double* slots, const Speeds<double>& speeds, bool convex,
                                                         GaussBlocks& sum) {
    for (std::size_t g = 0; g < gauss_points; ++g) {
        const Basis<double>& basis = gauss.basis[g];
        const BendingCurvature<double> at = bending_curvature(yarn, gauss.weight[g], guarded(speeds.speed[g], yarn),
                                                              speeds.tangent[g], combine(basis.bend, slots), convex);
        sum.slope[g].add(basis.slope, at.tt), sum.slope[g].add(basis.bend, at.tc);
        sum.bend[g].add(basis.slope, at.tc.transposed()), sum.bend[g].add(basis.bend, at.cc);
    }
}

/// What the second derivatives of one pair of samples are made of; u = y_a - y_b.
template <class Real>
struct PairCurvature {
    Real value = 0;            ///< f
    Real pull = 0;             ///< ∂f/∂u = pull · u
    Real side = 0, along = 0;  ///< ∂²f/∂u∂u = side · I + along · u uᵀ
};

/// `limit` is D², `square` |u|². Convex: only along the line that joins the samples; of those that coincide, everywhere.
template <class Real>
WEAVE_INLINE WEAVE_HD inline PairCurvature<Real> pair_curvature(Real square, Real limit, Real floor, bool convex) {
    const Real inverse = 1 / limit, s = square * inverse;
    const ContactLaw<Real> law = ContactLaw<Real>::at(s, floor);
    PairCurvature<Real> pair{law.value, 2 * law.slope * inverse, 0, 0};
    if (convex) {
        const Real along = 2 * inverse * std::max(law.slope + 2 * s * law.bend, -law.slope);
        if (square > 0) {
            pair.along = along / square;
        } else {
            pair.side = along;
        }
    } else {
        pair.side = pair.pull;
        pair.along = 4 * law.bend * inverse * inverse;
    }
    return pair;
}

}  // namespace weave::sim
