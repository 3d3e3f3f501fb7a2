#pragma once

// Second derivatives of one segment's energy by its four control slots, as 12 × 12 matrices. Formulas follow from the
// energies in bodies.hpp.

#include <weave/sim/bodies.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>

namespace weave::sim {

/// A 3×3 matrix column by column: plain numbers, which compilers bring into wide vectors better than matrices.
struct Nine {
    double at[9];

    /// a bᵀ
    [[gnu::always_inline]] static Nine outer(const Vec<double>& a, const Vec<double>& b) {
        return {{a[0] * b[0], a[1] * b[0], a[2] * b[0], a[0] * b[1], a[1] * b[1], a[2] * b[1], a[0] * b[2], a[1] * b[2],
                 a[2] * b[2]}};
    }
    /// s I + f a aᵀ
    [[gnu::always_inline]] static Nine along(double s, double f, const Vec<double>& a) {
        const double x = f * a[0], y = f * a[1], z = f * a[2];
        return {{s + x * a[0], y * a[0], z * a[0], x * a[1], s + y * a[1], z * a[1], x * a[2], y * a[2], s + z * a[2]}};
    }
    [[gnu::always_inline]] Nine& operator+=(const Nine& other) {
        for (int k = 0; k < 9; ++k) at[k] += other.at[k];
        return *this;
    }
    [[gnu::always_inline]] Nine transposed() const {
        return {{at[0], at[3], at[6], at[1], at[4], at[7], at[2], at[5], at[8]}};
    }
};

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

inline Mat<double> across(const Vec<double>& unit) {
    return Mat<double>::Identity() - unit * unit.transpose();
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

[[gnu::always_inline]] inline void add_stretch_curvature(const YarnConstants<double>& yarn, const Gauss<double>& gauss,
                                                         const Speeds<double>& speeds, double give, bool convex,
                                                         GaussBlocks& sum) {
    const bool fed = yarn.supply == Supply::tension;
    const double length = guarded(speeds.length, yarn), square = speeds.square, ratio = square / (length * length);
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
            const double both = weight * gauss.weight[h], own = g == h ? weight : 0;
            const double even = own / length - both * (speeds.speed[g] + speeds.speed[h]) / (length * length) +
                                both * square / (length * length * length);
            for (int d = 0; d < 4; ++d) others[d] += yarn.evenness_N * even * gauss.basis[h].slope[d] * units[h];
        }
        for (int d = 0; d < 4; ++d) {
            const Nine link = Nine::outer(units[g], others[d]);
            for (int k = 0; k < 9; ++k) sum.slope[g].block[9 * d + k] += link.at[k];
        }
    }
}

/// With T = y', C = y'', N = T × C: e = c |N|² |T|⁻⁵. Convex: twice c times JᵀJ of N |T|^(-5/2). Both come to the same
/// products with other factors, for C × N = |C|² T - (T·C) C and N × T = |T|² C - (T·C) T.
[[gnu::always_inline]] inline void add_bending_curvature(const YarnConstants<double>& yarn, const Gauss<double>& gauss,
                                                         const double* slots, const Speeds<double>& speeds, bool convex,
                                                         GaussBlocks& sum) {
    for (std::size_t g = 0; g < gauss_points; ++g) {
        const Basis<double>& basis = gauss.basis[g];
        const Vec<double> t = speeds.tangent[g], c = combine(basis.bend, slots);
        const double speed = guarded(speeds.speed[g], yarn), v2 = speed * speed;
        const double two = gauss.weight[g] * yarn.bending / (v2 * v2 * speed);  // 2c
        const double n2 = t.cross(c).squaredNorm(), c2 = c.squaredNorm(), t2 = t.squaredNorm(), along = t.dot(c);
        const Vec<double> by_t = c2 * t - along * c, by_c = t2 * c - along * t;
        const double mixed = (convex ? 2.5 : 5) * two / v2, own = (convex ? 6.25 : 17.5) * two * n2 / (v2 * v2),
                     less = convex ? 0 : 2.5 * two * n2 / v2;
        const Nine cc = Nine::along(two * t2, -two, t);
        Nine tt = Nine::along(two * c2 - less, -two, c), tc = Nine::outer(t, (convex ? two : 2 * two) * c - mixed * by_c);
        tt += Nine::outer(by_t, -mixed * t);
        tt += Nine::outer(t, own * t - mixed * by_t);
        for (int k = 0; k < 9; k += 4) tc.at[k] -= two * along;
        if (!convex) tc += Nine::outer(c, -two * t);
        sum.slope[g].add(basis.slope, tt), sum.slope[g].add(basis.bend, tc);
        sum.bend[g].add(basis.slope, tc.transposed()), sum.bend[g].add(basis.bend, cc);
    }
}

/// What the second derivatives of one pair of samples are made of; u = y_a - y_b.
struct PairCurvature {
    double value = 0;            ///< f
    double pull = 0;             ///< ∂f/∂u = pull · u
    double side = 0, along = 0;  ///< ∂²f/∂u∂u = side · I + along · u uᵀ
};

/// `limit` is D², `square` |u|². Convex: only along the line that joins the samples; of those that coincide, everywhere.
[[gnu::always_inline]] inline PairCurvature pair_curvature(double square, double limit, double floor, bool convex) {
    const double inverse = 1 / limit, s = square * inverse;
    const ContactLaw<double> law = ContactLaw<double>::at(s, floor);
    PairCurvature pair{law.value, 2 * law.slope * inverse, 0, 0};
    if (convex) {
        const double along = 2 * inverse * std::max(law.slope + 2 * s * law.bend, -law.slope);
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
