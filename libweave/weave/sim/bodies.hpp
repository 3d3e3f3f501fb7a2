#pragma once

// The arithmetic of the simulator as small bodies over views: no containers, no allocation, no globals. A backend runs
// a body once for every index of its range, in any order; no two indices write the same place. The same bodies run on
// the CPU and, compiled by nvcc, on a GPU.

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <cstdint>

#if defined(__CUDACC__)
#define WEAVE_HD __host__ __device__
#else
#define WEAVE_HD
#endif
/// Before a function template that runs wherever what it is given runs, a cloth or a crew: nvcc need not ask whether that is there.
#if defined(__CUDACC__)
#define WEAVE_ANYWHERE _Pragma("nv_exec_check_disable")
#else
#define WEAVE_ANYWHERE
#endif
/// Is compiled once and called: a relaxation in one kernel calls it from many places, and its threads wait far longer for one another
/// than a call takes.
#if defined(__CUDACC__)
#define WEAVE_CALLED __noinline__
#else
#define WEAVE_CALLED
#endif
/// Becomes part of whatever runs it, so that it is compiled for wide vectors with it (execute.hpp).
#define WEAVE_INLINE [[gnu::always_inline]]

namespace weave::sim {

template <class Real>
using Vec = Eigen::Matrix<Real, 3, 1>;
template <class Real>
using Mat = Eigen::Matrix<Real, 3, 3>;

/// Values of the four cubic B-splines that reach a segment, and of their first and second derivatives.
template <class Real>
struct Basis {
    Real value[4], slope[4], bend[4];
};

/// At `s` from 0 to 1 within the segment.
template <class Real>
WEAVE_HD inline Basis<Real> basis_at(Real s) {
    const Real r = 1 - s, sixth = Real(1) / 6;
    return {{r * r * r * sixth, (3 * s * s * s - 6 * s * s + 4) * sixth,
             (-3 * s * s * s + 3 * s * s + 3 * s + 1) * sixth, s * s * s * sixth},
            {-r * r / 2, (3 * s * s - 4 * s) / 2, (-3 * s * s + 2 * s + 1) / 2, s * s / 2},
            {r, 3 * s - 2, 1 - 3 * s, s}};
}

/// Four Gauss points of [0, 1]: exact for the stretch of any cubic.
inline constexpr std::size_t gauss_points = 4;
template <class Real>
struct Gauss {
    Basis<Real> basis[gauss_points];
    Real weight[gauss_points];
};

/// How a yarn resists being stretched.
enum class Supply : std::uint8_t {
    tension,  ///< fed at constant tension: the rest length follows (paper, section 5.1)
    length,   ///< a fixed length of yarn
};

/// Constants of one yarn.
template <class Real>
struct YarnConstants {
    Real radius_mm;
    Real stretch_N;    ///< EA
    Real bending;      ///< EI, N·mm²
    Real tension_N;    ///< EA (S - 1); of balanced yarns
    Real evenness_N;   ///< EA·S: keeps a balanced yarn's parameter even
    Real rest_mm;      ///< rest length of one segment; of yarns of fixed length
    Real root_k;       ///< square root of the contact stiffness, N^½/mm
    Supply supply;
    std::uint32_t samples;  ///< contact samples of one segment
    std::uint32_t basis;    ///< where its sample bases begin
};

/// Where a segment's data lies: its four control slots follow one another, so do its samples.
struct SegmentPlace {
    std::uint32_t slot, yarn, sample;
};

/// Contact samples, own ones first, then the halo: periodic images (or, later, those of other ranks).
template <class Real>
struct SamplesView {
    Real *x, *y, *z;
    Real* weight;  ///< √k · arc length that the sample stands for
    Real* radius;
};

/// Everything that the bodies read and write.
template <class Real>
struct FabricView {
    const Real* place;  ///< of slot i at 3i
    const SegmentPlace* segments;
    const YarnConstants<Real>* yarns;
    const Basis<Real>* bases;
    const Gauss<Real>* gauss;
    SamplesView<Real> samples;
    const std::uint32_t* first_neighbour;  ///< per own sample, and one more
    const std::uint32_t* neighbours;       ///< indices of samples
    Real floor;                            ///< least (d/D)² of the contact law; below it goes on linearly
    Real give;                             ///< strain beyond which yarns of fixed length give way, see StretchLaw
};

template <class Real>
WEAVE_HD inline Vec<Real> load(const Real* at) {
    return {at[0], at[1], at[2]};
}

template <class Real>
WEAVE_HD inline Vec<Real> combine(const Real (&weights)[4], const Real* slots) {
    return weights[0] * load(slots) + weights[1] * load(slots + 3) + weights[2] * load(slots + 6) +
           weights[3] * load(slots + 9);
}

/// Lays the contact samples of one segment.
template <class Real>
struct PlaceSamples {
    FabricView<Real> fabric;

    WEAVE_INLINE WEAVE_HD void operator()(std::size_t index) const {
        const SegmentPlace segment = fabric.segments[index];
        const YarnConstants<Real>& yarn = fabric.yarns[segment.yarn];
        const Real* slots = fabric.place + 3 * std::size_t(segment.slot);
        const Real share = yarn.root_k / Real(yarn.samples);
        for (std::uint32_t k = 0; k < yarn.samples; ++k) {
            const Basis<Real>& basis = fabric.bases[yarn.basis + k];
            const Vec<Real> at = combine(basis.value, slots);
            const std::size_t sample = segment.sample + k;
            fabric.samples.x[sample] = at.x();
            fabric.samples.y[sample] = at.y();
            fabric.samples.z[sample] = at.z();
            fabric.samples.weight[sample] = share * combine(basis.slope, slots).norm();
        }
    }
};

/// The contact law f as a function of s = (d/D)²: f = 1/s + s - 2 below 1 (Kaldor 2008), 0 beyond, and linear below the
/// floor, where yarns lie almost in one another.
template <class Real>
struct ContactLaw {
    Real value, slope, bend;  ///< f, df/ds, d²f/ds²

    WEAVE_HD static ContactLaw at(Real s, Real floor) {
        if (s >= 1) return {0, 0, 0};
        const Real c = s > floor ? s : floor, inverse = 1 / c;
        const Real slope = 1 - inverse * inverse;
        if (s > floor) return {inverse + s - 2, slope, 2 * inverse * inverse * inverse};
        return {inverse + c - 2 + slope * (s - c), slope, 0};
    }
};

/// What the neighbours of a sample do to it.
template <class Real>
struct ContactSum {
    Real spread = 0;            ///< Σ w_b f
    Real fx = 0, fy = 0, fz = 0;  ///< Σ w_b ∂f/∂y
};

/// Adds what one neighbour does: `apart` is the sample's place less the neighbour's, `reach` the sum of their radii, `weight` the
/// neighbour's.
template <class Real>
WEAVE_HD inline void add_neighbour(const Vec<Real>& apart, Real reach, Real weight, Real floor, ContactSum<Real>& sum) {
    const Real square = apart.squaredNorm(), limit = reach * reach;
    if (square >= limit) return;
    const Real inverse = 1 / limit;
    const ContactLaw<Real> law = ContactLaw<Real>::at(square * inverse, floor);
    const Real pull = 2 * weight * law.slope * inverse;
    sum.spread += weight * law.value;
    sum.fx += pull * apart.x();
    sum.fy += pull * apart.y();
    sum.fz += pull * apart.z();
}

#if !defined(__CUDACC__)
/// Four numbers that are worked on at once.
template <class Real>
struct FourOf {
    typedef Real type __attribute__((vector_size(4 * sizeof(Real))));
};

/// Four neighbours at once; the last four may be filled up with the sample itself, which counts nothing.
template <class Real>
[[gnu::always_inline]] inline ContactSum<Real> contact_of(const FabricView<Real>& fabric, std::size_t sample) {
    using Four = typename FourOf<Real>::type;
    const SamplesView<Real>& all = fabric.samples;
    const Real x = all.x[sample], y = all.y[sample], z = all.z[sample], radius = all.radius[sample];
    const std::uint32_t *at = fabric.neighbours + fabric.first_neighbour[sample],
                        *end = fabric.neighbours + fabric.first_neighbour[sample + 1];
    const Four nothing{};
    Four spread{}, fx{}, fy{}, fz{};
    for (; at < end; at += 4) {
        const std::ptrdiff_t left = end - at;
        const auto self = static_cast<std::uint32_t>(sample);
        const std::uint32_t b0 = at[0], b1 = left > 1 ? at[1] : self, b2 = left > 2 ? at[2] : self,
                            b3 = left > 3 ? at[3] : self;
        const Four dx = x - Four{all.x[b0], all.x[b1], all.x[b2], all.x[b3]},
                   dy = y - Four{all.y[b0], all.y[b1], all.y[b2], all.y[b3]},
                   dz = z - Four{all.z[b0], all.z[b1], all.z[b2], all.z[b3]},
                   reach = radius + Four{all.radius[b0], all.radius[b1], all.radius[b2], all.radius[b3]},
                   weight{all.weight[b0], left > 1 ? all.weight[b1] : 0, left > 2 ? all.weight[b2] : 0,
                          left > 3 ? all.weight[b3] : 0};
        const Four square = dx * dx + dy * dy + dz * dz, limit = reach * reach, floor = fabric.floor * limit;
        // ContactLaw::at, with one division for both 1/D² and the law's own.
        const Four held = square > floor ? square : floor, both = 1 / (limit * held), inverse = both * held,
                   up = both * limit * limit, slope = 1 - up * up;
        const Four value = up + held * inverse - 2 + slope * ((square - held) * inverse);
        const auto touches = square < limit;
        const Four pull = touches ? 2 * weight * slope * inverse : nothing;
        spread += touches ? weight * value : nothing;
        fx += pull * dx;
        fy += pull * dy;
        fz += pull * dz;
    }
    const auto sum = [](const Real(&v)[4]) { return (v[0] + v[1]) + (v[2] + v[3]); };
    return {sum({spread[0], spread[1], spread[2], spread[3]}), sum({fx[0], fx[1], fx[2], fx[3]}),
            sum({fy[0], fy[1], fy[2], fy[3]}), sum({fz[0], fz[1], fz[2], fz[3]})};
}
#endif

/// Energy of one segment and its gradient by the four slots.
template <class Real>
struct SegmentSum {
    Real energy = 0;
    Real gradient[12] = {};

    WEAVE_HD void add(const Real (&weights)[4], const Vec<Real>& force) {
        for (int c = 0; c < 4; ++c) {
            for (int k = 0; k < 3; ++k) gradient[3 * c + k] += weights[c] * force[k];
        }
    }
};

/// Length of a segment and the mean square of its speed |y'|.
template <class Real>
struct Speeds {
    Real speed[gauss_points];
    Vec<Real> tangent[gauss_points];
    Real length = 0, square = 0;

    WEAVE_HD Speeds(const Gauss<Real>& gauss, const Real* slots) {
        for (std::size_t g = 0; g < gauss_points; ++g) {
            tangent[g] = combine(gauss.basis[g].slope, slots);
            speed[g] = tangent[g].norm();
            length += gauss.weight[g] * speed[g];
            square += gauss.weight[g] * speed[g] * speed[g];
        }
    }
};

/// No tangent counts as shorter than this share of the yarn's radius a segment: bending would divide by nothing.
template <class Real>
WEAVE_HD inline Real guarded(Real speed, const YarnConstants<Real>& yarn) {
    const Real least = Real(1e-3) * yarn.radius_mm;
    return speed > least ? speed : least;
}

/// The stretch law φ of a yarn of fixed length: ½e² of the strain e; beyond `give` its slope hardly rises. Only the way to
/// rest gives way (relaxing.hpp): at rest `give` is infinite.
template <class Real>
struct StretchLaw {
    Real value, slope, bend;  ///< φ, dφ/de, d²φ/de²

    WEAVE_HD static StretchLaw at(Real strain, Real give) {
        if (strain <= give) return {strain * strain / 2, strain, 1};
        const Real bend = Real(0.02), over = strain - give;
        return {give * (give / 2 + over) + bend * over * over / 2, give + bend * over, bend};
    }
};

/// Stretch. Fixed length: ½·EA·L ∫(|y'|/L - 1)² ds. Constant tension: T·l + ½·EA·S ∫(|y'| - l)²/l ds, whose
/// stationary points are those of the paper's balanced strain L = l/S (section 5.1).
template <class Real>
WEAVE_INLINE WEAVE_HD inline void add_stretch(const YarnConstants<Real>& yarn, const Gauss<Real>& gauss,
                                 const Speeds<Real>& speeds, Real give, SegmentSum<Real>& sum) {
    const bool fed = yarn.supply == Supply::tension;
    const Real length = guarded(speeds.length, yarn), ratio = speeds.square / (length * length);
    if (fed) {
        sum.energy += yarn.tension_N * speeds.length +
                      yarn.evenness_N * (speeds.square / length - length) / 2;
    }
    for (std::size_t g = 0; g < gauss_points; ++g) {
        const Real speed = speeds.speed[g];
        Real pull = yarn.tension_N + yarn.evenness_N * (speed / length - (ratio + 1) / 2);
        if (!fed) {
            const StretchLaw<Real> law = StretchLaw<Real>::at((speed - yarn.rest_mm) / yarn.rest_mm, give);
            pull = yarn.stretch_N * law.slope;
            sum.energy += gauss.weight[g] * yarn.stretch_N * yarn.rest_mm * law.value;
        }
        sum.add(gauss.basis[g].slope, speeds.tangent[g] * (gauss.weight[g] * pull / guarded(speed, yarn)));
    }
}

/// Bending: ½·EI ∫κ² dl with κ² = |y'×y''|²/|y'|⁶; straight at rest.
template <class Real>
WEAVE_INLINE WEAVE_HD inline void add_bending(const YarnConstants<Real>& yarn, const Gauss<Real>& gauss, const Real* slots,
                                 const Speeds<Real>& speeds, SegmentSum<Real>& sum) {
    for (std::size_t g = 0; g < gauss_points; ++g) {
        const Vec<Real> tangent = speeds.tangent[g], bend = combine(gauss.basis[g].bend, slots);
        const Real speed = guarded(speeds.speed[g], yarn), square = speed * speed;
        const Real scale = gauss.weight[g] * yarn.bending / (2 * square * square * speed);
        const Real along = tangent.dot(bend), own = tangent.squaredNorm(), bent = bend.squaredNorm();
        // |y' × y''|² by its parts: |y'|²|y''|² − (y'·y'')² would leave nothing but rounding where both run alike.
        const Real nx = tangent.y() * bend.z() - tangent.z() * bend.y(), ny = tangent.z() * bend.x() - tangent.x() * bend.z(),
                   nz = tangent.x() * bend.y() - tangent.y() * bend.x(), twist = nx * nx + ny * ny + nz * nz;
        sum.energy += scale * twist;
        sum.add(gauss.basis[g].bend, (own * bend - along * tangent) * (2 * scale));
        const Real fall = speeds.speed[g] >= speed ? 5 * twist / square : Real(0);
        sum.add(gauss.basis[g].slope, (tangent * (2 * bent - fall) - bend * (2 * along)) * scale);
    }
}

/// Contact: k ∬ f(d/D) dl dl over current arc length, both derivatives: by place and by arc length. Every pair is seen
/// from both sides, so each side counts half the energy and the whole of its own force. `contact_at(k)` is what the neighbours do to
/// the segment's k-th sample, `weight_at(k)` that sample's.
template <class Real, class ContactOf, class WeightOf>
WEAVE_INLINE WEAVE_HD inline void add_contact(const YarnConstants<Real>& yarn, const Basis<Real>* bases, const Real* slots,
                                 const ContactOf& contact_at, const WeightOf& weight_at, SegmentSum<Real>& sum) {
    const Real share = yarn.root_k / Real(yarn.samples);
    for (std::uint32_t k = 0; k < yarn.samples; ++k) {
        const ContactSum<Real> contact = contact_at(k);
        if (contact.spread == 0) continue;
        const Basis<Real>& basis = bases[k];
        const Real weight = weight_at(k);
        sum.energy += weight * contact.spread / 2;
        sum.add(basis.value, Vec<Real>(contact.fx, contact.fy, contact.fz) * weight);
        const Vec<Real> tangent = combine(basis.slope, slots);
        sum.add(basis.slope, tangent * (share * contact.spread / guarded(tangent.norm(), yarn)));
    }
}

/// Which forces a pass adds up.
struct Terms {
    bool elastic = true, contact = true;
};

#if !defined(__CUDACC__)
/// Energy and gradient of one segment.
template <class Real>
struct SegmentForces {
    FabricView<Real> fabric;
    Terms terms;
    Real* energy;    ///< per segment
    Real* gradient;  ///< 12 per segment

    WEAVE_INLINE WEAVE_HD void operator()(std::size_t index) const {
        const SegmentPlace segment = fabric.segments[index];
        const YarnConstants<Real>& yarn = fabric.yarns[segment.yarn];
        const Real* slots = fabric.place + 3 * std::size_t(segment.slot);
        SegmentSum<Real> sum;
        if (terms.elastic) {
            const Speeds<Real> speeds(*fabric.gauss, slots);
            add_stretch(yarn, *fabric.gauss, speeds, fabric.give, sum);
            add_bending(yarn, *fabric.gauss, slots, speeds, sum);
        }
        if (terms.contact) {
            add_contact(
                yarn, fabric.bases + yarn.basis, slots,
                [&](std::uint32_t k) __attribute__((always_inline)) { return contact_of(fabric, segment.sample + k); },
                [&](std::uint32_t k) __attribute__((always_inline)) { return fabric.samples.weight[segment.sample + k]; }, sum);
        }
        energy[index] = sum.energy;
        for (int k = 0; k < 12; ++k) gradient[12 * index + std::size_t(k)] = sum.gradient[k];
    }
};
#endif

}  // namespace weave::sim
