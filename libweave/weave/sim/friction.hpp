#pragma once

// Friction between yarns: quasi-static Coulomb friction by a lagged potential (Li et al. 2020, Incremental
// Potential Contact, section 5). Where contact samples touch, how hard they press and which way is across the
// contact is held while yarns relax; how far each pair has slipped since the start then costs μ·λ·f(slip),
// whose slope never exceeds the Coulomb limit μ·λ. friction_rounds.hpp renews what is held until it agrees
// with what comes out.

#include <weave/sim/bodies.hpp>
#include <weave/sim/execute.hpp>
#include <weave/sim/fabric.hpp>
#include <weave/sim/neighbours.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace weave::sim {

/// Slip at which friction has all but its full force, as a share of the mean radius of the two yarns. Below
/// it they stick: they give way by this much at most, as on a very stiff spring.
inline constexpr double stick_share = 0.01;

/// The potential of slip f: its slope rises from 0 to 1 over the transition length ε and stays 1 beyond.
template <class Real>
struct SlipLaw {
    Real value;      ///< f, mm
    Real stiffness;  ///< f'/y, 1/mm
    Real bend;       ///< (f'' - f'/y) / y², 1/mm³; never above 0

    WEAVE_HD static SlipLaw at(Real y, Real epsilon) {
        if (y >= epsilon) return {y - epsilon / 3, 1 / y, -1 / (y * y * y)};
        const Real share = y / epsilon;
        const Real bend = y > 0 ? -1 / (epsilon * epsilon * y) : Real(0);
        return {y * share * (1 - share / 3), (2 - share) / epsilon, bend};
    }
};

/// What is held of one own sample that touches another, seen from the first; the other has the same seen from
/// there.
template <class Real>
struct FrictionPair {
    Real normal[3];       ///< unit, across both yarns
    Real rest[3];         ///< place of the first less that of the other where they have not slipped, mm
    Real limit_N;         ///< μ·λ: the greatest force of friction
    Real epsilon_mm;      ///< transition length of SlipLaw
    std::uint32_t other;  ///< an own sample
    std::array<std::int16_t, 2> image;  ///< of the other, that is touched
};

template <class Real>
struct FrictionView {
    const std::uint32_t* first;  ///< per own sample, and one more
    const FrictionPair<Real>* pairs;
};

/// How far a pair has slipped, and what that costs.
template <class Real>
struct PairSlip {
    Vec<Real> slip;  ///< mm, in the plane of the contact
    Real far;
    SlipLaw<Real> law;

    WEAVE_HD PairSlip(const FrictionPair<Real>& pair, const Vec<Real>& apart) {
        const Vec<Real> normal = load(pair.normal), moved = apart - load(pair.rest);
        slip = moved - normal * normal.dot(moved);
        far = slip.norm();
        law = SlipLaw<Real>::at(far, pair.epsilon_mm);
    }
};

template <class Real>
WEAVE_HD inline Vec<Real> place_of(const SamplesView<Real>& samples, std::size_t sample) {
    return {samples.x[sample], samples.y[sample], samples.z[sample]};
}

/// Adds μ·Σ λ f(slip) of one segment: as with contact each side of a pair counts half the energy and its own
/// force.
template <class Real>
struct FrictionForces {
    FabricView<Real> fabric;
    FrictionView<Real> friction;
    Real* energy;    ///< per segment; added to
    Real* gradient;  ///< 12 per segment; added to

    WEAVE_HD void operator()(std::size_t index) const {
        const SegmentPlace segment = fabric.segments[index];
        const YarnConstants<Real>& yarn = fabric.yarns[segment.yarn];
        SegmentSum<Real> sum;
        for (std::uint32_t k = 0; k < yarn.samples; ++k) {
            const std::size_t sample = segment.sample + k;
            const Vec<Real> at = place_of(fabric.samples, sample);
            Vec<Real> force = Vec<Real>::Zero();
            for (std::uint32_t p = friction.first[sample]; p < friction.first[sample + 1]; ++p) {
                const FrictionPair<Real>& pair = friction.pairs[p];
                const PairSlip<Real> slip(pair, at - place_of(fabric.samples, pair.other));
                sum.energy += pair.limit_N * slip.law.value / 2;
                force += slip.slip * (pair.limit_N * slip.law.stiffness);
            }
            sum.add(fabric.bases[yarn.basis + k].value, force);
        }
        energy[index] += sum.energy;
        for (int k = 0; k < 12; ++k) gradient[12 * index + std::size_t(k)] += sum.gradient[k];
    }
};

/// Second derivatives of a pair's energy by the place of its first sample; by that of the other they are the
/// same with the sign turned. They curve nowhere down, since the potential is convex.
template <class Real>
WEAVE_HD inline Mat<double> friction_curvature(const FrictionPair<Real>& pair, const Vec<Real>& apart) {
    const PairSlip<Real> slip(pair, apart);
    const Vec<double> normal = load(pair.normal).template cast<double>(),
                      way = slip.slip.template cast<double>();
    const Mat<double> in_plane = Mat<double>::Identity() - normal * normal.transpose();
    return double(pair.limit_N) *
           (double(slip.law.stiffness) * in_plane + double(slip.law.bend) * way * way.transpose());
}

/// Unit tangents of one segment's contact samples.
template <class Real>
struct PlaceTangents {
    FabricView<Real> fabric;
    Real* tangents;  ///< 3 per own sample

    WEAVE_HD void operator()(std::size_t index) const {
        const SegmentPlace segment = fabric.segments[index];
        const YarnConstants<Real>& yarn = fabric.yarns[segment.yarn];
        const Real* slots = fabric.place + 3 * std::size_t(segment.slot);
        for (std::uint32_t k = 0; k < yarn.samples; ++k) {
            const Vec<Real> tangent = combine(fabric.bases[yarn.basis + k].slope, slots);
            const Vec<Real> unit = tangent / guarded(tangent.norm(), yarn);
            for (int c = 0; c < 3; ++c) tangents[3 * std::size_t(segment.sample + k) + std::size_t(c)] = unit[c];
        }
    }
};

/// How hard a pair of samples presses, and across which direction.
template <class Real>
struct PairPress {
    Vec<Real> normal;
    Real press_N = 0;  ///< 0 where they do not touch, or lie in one another

    /// `apart`: place of a less that of b; unit tangents of both. The normal is square to both yarns, and
    /// where these run the same way the part of `apart` that is square to them. What a soft contact pushes
    /// yarns along themselves with does not press.
    WEAVE_HD PairPress(const FabricView<Real>& fabric, std::size_t a, std::size_t b, const Vec<Real>& along_a,
                       const Vec<Real>& along_b) {
        const SamplesView<Real>& all = fabric.samples;
        const Vec<Real> apart = place_of(all, a) - place_of(all, b);
        const Real reach = all.radius[a] + all.radius[b], limit = reach * reach, square = apart.squaredNorm();
        if (square >= limit) return;
        // Least squares that do not ask which of two parallel tangents it is; a thousandth keeps them
        // solvable.
        const Real own = Real(1.001), both = along_a.dot(along_b), det = own * own - both * both;
        const Real pa = along_a.dot(apart), pb = along_b.dot(apart);
        normal = apart - along_a * ((own * pa - both * pb) / det) - along_b * ((own * pb - both * pa) / det);
        const Real size = normal.norm();
        if (!(size > Real(1e-6) * reach)) return;
        normal /= size;
        const ContactLaw<Real> law = ContactLaw<Real>::at(square / limit, fabric.floor);
        const Real press = -2 * all.weight[a] * all.weight[b] * law.slope / limit * apart.dot(normal);
        press_N = press > 0 ? press : Real(0);
    }
};

/// Lists the pairs of one own sample that press; run once to count them and once to fill them in.
template <class Real>
struct HoldPairs {
    FabricView<Real> fabric;
    const HaloSample* halo;  ///< of sample `own_samples` + i
    std::size_t own_samples;
    const Real *tangents, *starts;  ///< 3 per own sample; starts: where slip counts from
    Real grown[2];                  ///< periods now less those at the start, mm
    Real coefficient, stick;        ///< μ; ε over the mean radius
    std::uint32_t* first;           ///< per own sample: how many (counting), or where its own begin
    FrictionPair<Real>* pairs;      ///< null: only count

    WEAVE_HD void operator()(std::size_t a) const {
        std::uint32_t count = 0;
        const Vec<Real> along = load(tangents + 3 * a);
        for (std::uint32_t e = fabric.first_neighbour[a]; e < fabric.first_neighbour[a + 1]; ++e) {
            const std::uint32_t b = fabric.neighbours[e];
            const bool is_image = b >= own_samples;
            const std::uint32_t of = is_image ? halo[b - own_samples].of : b;
            const PairPress<Real> press(fabric, a, b, along, load(tangents + 3 * std::size_t(of)));
            if (!(press.press_N > 0)) continue;
            if (pairs != nullptr) {
                FrictionPair<Real>& pair = pairs[first[a] + count];
                pair.other = of;
                pair.image = {};
                if (is_image) pair.image = halo[b - own_samples].image;
                pair.limit_N = coefficient * press.press_N;
                pair.epsilon_mm = stick * (fabric.samples.radius[a] + fabric.samples.radius[b]) / 2;
                for (std::size_t c = 0; c < 3; ++c) {
                    pair.normal[c] = press.normal[int(c)];
                    pair.rest[c] = starts[3 * a + c] - starts[3 * std::size_t(of) + c];
                    if (c < 2) pair.rest[c] += Real(pair.image[c]) * grown[c];
                }
            }
            ++count;
        }
        if (pairs == nullptr) first[a] = count;
    }
};

/// What came of the pairs that touch.
struct SlipSummary {
    double press_N = 0;      ///< normal force of all pairs, each counted once
    double stuck_share = 0;  ///< of that force: in pairs that have slipped by less than the transition length
    double farthest_mm = 0;  ///< greatest slip of a pair since the start
};

/// Pairs of samples as they are held. Without pairs there is no friction, and it costs nothing.
template <class Real>
class Friction {
  public:
    explicit Friction(const Fabric<Real>& fabric);

    [[nodiscard]] bool is_on() const { return !m_pairs.empty(); }
    [[nodiscard]] FrictionView<Real> view() const { return {m_first.data(), m_pairs.data()}; }

    /// Holds the pairs that press in a state, whose samples and neighbours the view has; `stick` is ε over
    /// the mean radius of the two.
    void renew(const FabricView<Real>& fabric, const Neighbours<Real>& neighbours, const Executor& executor,
               double stick);
    /// Lets go of all pairs.
    void clear();
    /// Bumped by each renewal.
    [[nodiscard]] std::size_t renewals() const { return m_renewals; }

    /// ∂/∂P of its energy through the images in the pairs, periods in x and y, at fixed places of the own
    /// samples.
    [[nodiscard]] std::array<double, 2> image_pull(const FabricView<Real>& fabric) const;
    [[nodiscard]] SlipSummary summary(const FabricView<Real>& fabric) const;

  private:
    const Fabric<Real>& m_fabric;
    std::vector<Real> m_starts;  ///< 3 per own sample
    std::array<double, 2> m_start_period{};
    std::vector<std::uint32_t> m_first;
    std::vector<FrictionPair<Real>> m_pairs;
    std::size_t m_renewals = 0;
};

extern template class Friction<float>;
extern template class Friction<double>;

}  // namespace weave::sim
