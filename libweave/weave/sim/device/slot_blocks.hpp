#pragma once

// Second derivatives as far as they belong to one segment, or to two whose samples touch: 4 × 4 blocks by their slots. Formulas:
// hessian_terms.hpp. A thread makes one row of four blocks, so that its 36 sums stay in registers.

#include <weave/sim/device/cloth_view.hpp>
#include <weave/sim/device/lists_view.hpp>
#include <weave/sim/device/shape.hpp>
#include <weave/sim/hessian_terms.hpp>

#include <cstddef>
#include <cstdint>

namespace weave::sim {

/// Which second derivatives, and of what law.
template <class Real>
struct CurvatureLaw {
    bool convex = true;  ///< only what curves upwards, see Curvature
    Real give = 0;       ///< see StretchLaw
};

/// What contact adds up to at one sample, w being its weight, T its tangent with unit t.
template <class Real>
struct SampleSums {
    Real yy[6];      ///< Σ w_b ∂²f/∂y∂y: xx, xy, yy, xz, yz, zz
    Real side;       ///< of the weight's own curvature: that is side · (I - t tᵀ)
    Real push[3];    ///< Σ w_b ∂f/∂y; only of the exact law
    Real pull[3];    ///< ∂w/∂T = pull; only of the exact law
};

template <class Real>
struct SumSample {
    ClothView<Real> cloth;
    ListsView<Real> lists;
    StateView state;
    View<SampleSums<Real>> sums;
    bool convex;

    WEAVE_HD void operator()(std::size_t a) const {
        const SegmentPlace place = cloth.segment[cloth.segment_of_sample[a]];
        const YarnConstants<Real>& yarn = cloth.yarn[place.yarn];
        SampleSums<Real> sum{};
        Real spread = 0;
        bool touches = false;
        const Sample<Real> own = lists.sample[a];
        const Real radius = lists.radius[a], step = Real(cloth.scale.step_mm);
        for (std::uint32_t e = lists.first[a], end = lists.first[a + 1]; e < end; ++e) {
            const std::uint32_t b = lists.neighbour[e];
            const Sample<Real> other = lists.sample[b];
            const Vec<Real> u = apart(own, other, step);
            const Real reach = radius + lists.radius[b], square = u.squaredNorm();
            if (square >= reach * reach) continue;
            touches = true;  // where yarns just touch the spread may be lost in rounding, and the curvature is not
            const PairCurvature<Real> pair = pair_curvature(square, reach * reach, cloth.floor, convex);
            const Real side = other.weight * pair.side, along = other.weight * pair.along, pull = other.weight * pair.pull;
            spread += other.weight * pair.value;
            for (int j = 0, at = 0; j < 3; ++j) {
                for (int i = 0; i <= j; ++i, ++at) sum.yy[at] += along * u[i] * u[j] + (i == j ? side : 0);
                sum.push[j] += pull * u[j];
            }
        }
        if (touches || !convex) {
            Real slots[12];
            load_around_first(state, place.slot, slots);
            const Vec<Real> tangent = combine(cloth.basis[yarn.basis + (std::uint32_t(a) - place.sample)].slope, slots);
            const Real per_length = yarn.root_k / Real(yarn.samples) / guarded(tangent.norm(), yarn);
            sum.side = per_length * spread;
            for (int k = 0; k < 3; ++k) sum.pull[k] = per_length * tangent[k];
        }
        sums[a] = sum;
    }
};

/// Makes slot blocks: `count` times 4 rows of them. The first `pairs` are those of pairs from `first_pair` on, then come the own ones
/// of segments from `first_segment` on.
template <class Real>
struct MakeSlotBlocks {
    ClothView<Real> cloth;
    ListsView<Real> lists;
    StateView state;
    NearView near;
    View<const SampleSums<Real>> sums;
    View<float> blocks;
    CurvatureLaw<Real> law;
    std::uint32_t first_segment, first_pair, pairs;

    WEAVE_HD void operator()(std::size_t i) const {
        const auto block = static_cast<std::uint32_t>(i / 4);
        const int c = static_cast<int>(i % 4);
        Real sum[36];
        for (Real& number : sum) number = 0;
        if (block < pairs) add_pair(first_pair + block, c, sum);
        else add_own(first_segment + (block - pairs), c, sum);
        float* to = blocks.at(144 * std::size_t(block) + 36 * std::size_t(c), 36);
        for (int k = 0; k < 36; ++k) to[k] = static_cast<float>(sum[k]);
    }

  private:
    /// Adds A_d H to each block d.
    WEAVE_INLINE WEAVE_HD static void add(Real (&sum)[36], const Real (&columns)[4], Real row, const NineOf<Real>& h) {
        for (int d = 0; d < 4; ++d) {
            const Real both = row * columns[d];
            for (int k = 0; k < 9; ++k) sum[9 * d + k] += both * h.at[k];
        }
    }

    WEAVE_HD void add_pair(std::uint32_t pair, int c, Real (&sum)[36]) const {
        const std::uint32_t owner = near.owner[pair], other = near.segment[near.first[owner] + (pair - near.first_pair[owner])];
        const SegmentPlace mine = cloth.segment[owner], theirs = cloth.segment[other];
        const YarnConstants<Real>& my_yarn = cloth.yarn[mine.yarn];
        const YarnConstants<Real>& their_yarn = cloth.yarn[theirs.yarn];
        const std::uint32_t past = theirs.sample + their_yarn.samples;
        for (std::uint32_t k = 0; k < my_yarn.samples; ++k) {
            const std::uint32_t a = mine.sample + k, end = lists.first[a + 1];
            std::uint32_t e = first_neighbour_from(lists, a, theirs.sample);
            if (e == end) continue;
            const Basis<Real>& basis = cloth.basis[my_yarn.basis + k];
            const Sample<Real> sample = lists.sample[a];
            const Real radius = lists.radius[a];
            for (; e < end; ++e) {
                const std::uint32_t b = lists.neighbour[e], own = lists.own_of(b);
                if (own >= past) break;
                const Sample<Real> met = lists.sample[b];
                const Vec<Real> u = apart(sample, met, Real(cloth.scale.step_mm));
                const Real reach = radius + lists.radius[b], square = u.squaredNorm();
                if (square >= reach * reach) continue;
                const PairCurvature<Real> curve = pair_curvature(square, reach * reach, cloth.floor, law.convex);
                add_meeting(curve, u, sample.weight * basis.value[c], basis.slope[c], met.weight, a, own,
                            cloth.basis[their_yarn.basis + (own - theirs.sample)], sum);
            }
        }
    }

    /// One pair of samples a and b with their weights w and pulls p, E = w_a w_b f(u). `value` is w_a times the row's share in a's
    /// place, `slope` the row's share in its tangent:
    /// ∂²E/∂a∂b = -value w_b f'' - slope p_a w_b f'ᵀ by b's place, and value f' p_bᵀ + slope f p_a p_bᵀ by its tangent.
    WEAVE_INLINE WEAVE_HD void add_meeting(const PairCurvature<Real>& curve, const Vec<Real>& u, Real value, Real slope, Real weight,
                                           std::size_t a, std::size_t b, const Basis<Real>& basis, Real (&sum)[36]) const {
        Vec<Real> by_place = (value * weight * curve.along) * u;
        const Real side = value * weight * curve.side;
        if (law.convex) {
            for (int d = 0; d < 4; ++d) {
                for (int j = 0; j < 3; ++j) {
                    const Real column = basis.value[d] * u[j];
                    for (int i = 0; i < 3; ++i) sum[9 * d + 3 * j + i] -= column * by_place[i];
                    sum[9 * d + 4 * j] -= basis.value[d] * side;
                }
            }
            return;
        }
        const Vec<Real> my_pull = load(sums[a].pull), their_pull = load(sums[b].pull);
        by_place += (slope * weight * curve.pull) * my_pull;
        const Vec<Real> by_tangent = (value * curve.pull) * u + (slope * curve.value) * my_pull;
        for (int d = 0; d < 4; ++d) {
            for (int j = 0; j < 3; ++j) {
                const Real column = basis.value[d] * u[j], tangent = basis.slope[d] * their_pull[j];
                for (int i = 0; i < 3; ++i) sum[9 * d + 3 * j + i] += tangent * by_tangent[i] - column * by_place[i];
                sum[9 * d + 4 * j] -= basis.value[d] * side;
            }
        }
    }

    WEAVE_HD void add_own(std::uint32_t segment, int c, Real (&sum)[36]) const {
        const SegmentPlace place = cloth.segment[segment];
        const YarnConstants<Real>& yarn = cloth.yarn[place.yarn];
        const Gauss<Real>& gauss = cloth.gauss[0];
        Real slots[12];
        load_around_first(state, place.slot, slots);
        const Speeds<Real> speeds(gauss, slots);
        add_stretch(yarn, gauss, speeds, c, sum);
        for (std::size_t g = 0; g < gauss_points; ++g) {
            const Basis<Real>& basis = gauss.basis[g];
            const BendingCurvature<Real> bending = bending_curvature(yarn, gauss.weight[g], guarded(speeds.speed[g], yarn),
                                                                     speeds.tangent[g], combine(basis.bend, slots), law.convex);
            add(sum, basis.slope, basis.slope[c], bending.tt);
            add(sum, basis.bend, basis.slope[c], bending.tc);
            add(sum, basis.slope, basis.bend[c], bending.tc.transposed());
            add(sum, basis.bend, basis.bend[c], bending.cc);
        }
        if (cloth.fields > 0) add_fields(place, yarn, gauss, slots, speeds, c, sum);
        for (std::uint32_t k = 0; k < yarn.samples; ++k)
            add_sample(place.sample + k, yarn.root_k / Real(yarn.samples), cloth.basis[yarn.basis + k], c, sum);
    }

    WEAVE_HD void add_stretch(const YarnConstants<Real>& yarn, const Gauss<Real>& gauss, const Speeds<Real>& speeds, int c,
                              Real (&sum)[36]) const {
        const Real length = guarded(speeds.length, yarn), ratio = speeds.square / (length * length);
        for (std::size_t g = 0; g < gauss_points; ++g) {
            const Basis<Real>& basis = gauss.basis[g];
            const Real speed = guarded(speeds.speed[g], yarn);
            const Vec<Real> unit = speeds.tangent[g] / speed;
            const StretchCurvature<Real> own = stretch_curvature(yarn, gauss.weight[g], speed, length, ratio, law.give, law.convex);
            add(sum, basis.slope, basis.slope[c], NineOf<Real>::along(own.side, own.along, unit));
            if (yarn.supply != Supply::tension) continue;
            // What evenness links: the speeds at all Gauss points.
            Vec<Real> others = Vec<Real>::Zero();
            for (std::size_t h = 0; h < gauss_points; ++h) {
                others += (yarn.evenness_N * evenness_link(gauss, speeds, length, g, h) * gauss.basis[h].slope[c] /
                           guarded(speeds.speed[h], yarn)) * speeds.tangent[h];
            }
            add(sum, basis.slope, 1, NineOf<Real>::outer(others, unit));
        }
    }

    WEAVE_HD void add_fields(const SegmentPlace& place, const YarnConstants<Real>& yarn, const Gauss<Real>& gauss,
                             const Real (&slots)[12], const Speeds<Real>& speeds, int c, Real (&sum)[36]) const {
        const double* first = state.at(3 * std::size_t(place.slot), 3);
        for (std::uint32_t s = 0; s < cloth.fields; ++s) {
            Sphere<Real> sphere = cloth.spheres[s];
            for (int k = 0; k < 3; ++k) sphere.centre[k] = static_cast<Real>(static_cast<double>(sphere.centre[k]) - first[k]);
            for (std::size_t g = 0; g < gauss_points; ++g) {
                const Basis<Real>& basis = gauss.basis[g];
                const SpherePush<Real> push(sphere, combine(basis.value, slots));
                if (push.depth <= 0 || push.distance <= 0) continue;
                const Real speed = guarded(speeds.speed[g], yarn);
                const Vec<Real> unit = speeds.tangent[g] / speed;
                const FieldCurvature<Real> field =
                    field_curvature(yarn, gauss.weight[g], speed, unit, sphere.stiffness, push, law.convex);
                add(sum, basis.value, basis.value[c], nine(field.yy));
                if (yarn.supply != Supply::tension) continue;
                add(sum, basis.slope, basis.slope[c], nine(field.tt));
                if (law.convex) continue;
                add(sum, basis.slope, basis.value[c], nine(field.yt));
                add(sum, basis.value, basis.slope[c], nine(field.yt).transposed());
            }
        }
    }

    WEAVE_INLINE WEAVE_HD static NineOf<Real> nine(const Mat<Real>& matrix) {
        NineOf<Real> same;
        for (int k = 0; k < 9; ++k) same.at[k] = matrix.data()[k];
        return same;
    }

    /// What all that touches one sample adds to its own slots: the weight's second derivative is across the tangent.
    /// `share`: its weight over |T|, and so that of its pull over T's unit.
    WEAVE_HD void add_sample(std::size_t a, Real share, const Basis<Real>& basis, int c, Real (&sum)[36]) const {
        const SampleSums<Real>& at = sums[a];
        if (at.side == 0 && at.yy[0] + at.yy[2] + at.yy[5] == 0) return;  // touches nothing
        const Real value = lists.sample[a].weight * basis.value[c], slope = basis.slope[c];
        const Vec<Real> pull = load(at.pull), push = load(at.push);
        const Real across = slope * at.side, less = across / (share * share);
        NineOf<Real> by_place{{value * at.yy[0], value * at.yy[1], value * at.yy[3], value * at.yy[1], value * at.yy[2],
                               value * at.yy[4], value * at.yy[3], value * at.yy[4], value * at.yy[5]}};
        NineOf<Real> by_tangent = NineOf<Real>::along(across, -less, pull);
        if (!law.convex) {
            by_place += NineOf<Real>::outer(slope * pull, push);
            by_tangent += NineOf<Real>::outer(basis.value[c] * push, pull);
        }
        add(sum, basis.value, 1, by_place);
        add(sum, basis.slope, 1, by_tangent);
    }
};

}  // namespace weave::sim
