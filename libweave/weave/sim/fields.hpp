#pragma once

// Spherical force fields: what opens a pocket. A field pushes on every length of yarn alike, so its effect does not
// depend on how many control points a yarn has.

#include <weave/sim/bodies.hpp>
#include <weave/sim/hessian_terms.hpp>
#include <weave/sim/scene.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace weave::sim {

/// A field as the bodies read it: φ = ½·stiffness·depth², N (an energy per length of yarn), depth being the distance
/// below the sphere's surface.
template <class Real>
struct Sphere {
    Vec<Real> centre;
    Real radius, stiffness;  ///< mm, N/mm²
};

/// φ and ∂φ/∂y at a place. At the very centre no direction leads out: the push is 0 there.
template <class Real>
struct SpherePush {
    Real value = 0, depth = 0, distance = 0;
    Vec<Real> out;  ///< unit, from the centre

    WEAVE_HD SpherePush(const Sphere<Real>& sphere, const Vec<Real>& at) : out(at - sphere.centre) {
        distance = out.norm();
        depth = sphere.radius - distance;
        if (depth <= 0) return;
        value = sphere.stiffness * depth * depth / 2;
        out = distance > 0 ? Vec<Real>(out / distance) : Vec<Real>(Vec<Real>::Zero());
    }
};

/// Adds ∫ φ(y) dl of one segment. A yarn of fixed length counts its own unstretched length; a fed one, which runs
/// through, that which lies there: its tension then rises by φ inside, as force along the yarn asks. `sphere_at(s)` is field s,
/// `slots` count from where its centre does.
template <class Real, class SphereAt>
WEAVE_HD inline void add_fields(const YarnConstants<Real>& yarn, const Gauss<Real>& gauss, const Real* slots, std::size_t count,
                                const SphereAt& sphere_at, SegmentSum<Real>& sum) {
    for (std::size_t g = 0; g < gauss_points; ++g) {
        const Basis<Real>& basis = gauss.basis[g];
        const Vec<Real> at = combine(basis.value, slots), tangent = combine(basis.slope, slots);
        const bool fed = yarn.supply == Supply::tension;
        const Real speed = tangent.norm(), share = gauss.weight[g] * (fed ? speed : yarn.rest_mm);
        for (std::size_t s = 0; s < count; ++s) {
            const Sphere<Real> sphere = sphere_at(s);
            const SpherePush<Real> push(sphere, at);
            if (push.depth <= 0) continue;
            sum.energy += share * push.value;
            sum.add(basis.value, push.out * (-share * sphere.stiffness * push.depth));
            if (fed) sum.add(basis.slope, tangent * (gauss.weight[g] * push.value / guarded(speed, yarn)));
        }
    }
}

template <class Real>
struct FieldForces {
    FabricView<Real> fabric;
    const Sphere<Real>* spheres;
    std::size_t count;
    Real* energy;    ///< per segment; added to
    Real* gradient;  ///< 12 per segment; added to

    WEAVE_HD void operator()(std::size_t index) const {
        const SegmentPlace segment = fabric.segments[index];
        SegmentSum<Real> sum;
        add_fields(fabric.yarns[segment.yarn], *fabric.gauss, fabric.place + 3 * std::size_t(segment.slot), count,
                   [this](std::size_t s) { return spheres[s]; }, sum);
        energy[index] += sum.energy;
        for (int k = 0; k < 12; ++k) gradient[12 * index + std::size_t(k)] += sum.gradient[k];
    }
};

/// The fields of a scene for the bodies; their strength acts at the centre and falls evenly to nothing at the surface.
template <class Real>
std::vector<Sphere<Real>> spheres_of(const SimScene& scene) {
    std::vector<Sphere<Real>> spheres;
    for (const ForceField& field : scene.fields) {
        const Vec<double> centre(field.centre_mm[0], field.centre_mm[1], field.centre_mm[2]);
        spheres.push_back({centre.cast<Real>(), static_cast<Real>(field.radius_mm),
                           static_cast<Real>(field.strength_N_per_mm / field.radius_mm)});
    }
    return spheres;
}

/// Second derivatives of a field at one Gauss point, by the place y and the slope y' (t) there.
template <class Real>
struct FieldCurvature {
    Mat<Real> yy, yt, tt;
};

/// Convex: only what curves upwards; yt is then left. So is what only fed yarns have, of others. `unit` is that of the tangent,
/// `speed` its length.
template <class Real>
WEAVE_INLINE WEAVE_HD inline FieldCurvature<Real> field_curvature(const YarnConstants<Real>& yarn, Real weight, Real speed,
                                                                  const Vec<Real>& unit, Real stiffness,
                                                                  const SpherePush<Real>& push, bool convex) {
    const bool fed = yarn.supply == Supply::tension;
    Real along = stiffness, side = -stiffness * push.depth / push.distance, pull = push.value / speed;
    if (convex) along = std::max(along, Real(0)), side = std::max(side, Real(0)), pull = std::max(pull, Real(0));
    FieldCurvature<Real> all;
    const Mat<Real> by_place = along * push.out * push.out.transpose() + side * across(push.out);
    all.yy = weight * (fed ? speed : yarn.rest_mm) * by_place;
    if (fed) all.tt = weight * pull * across(unit);
    if (fed && !convex) all.yt = -weight * stiffness * push.depth * push.out * unit.transpose();
    return all;
}

inline void add_field_curvature(const YarnConstants<double>& yarn, const Gauss<double>& gauss, const double* slots,
                                const std::vector<Sphere<double>>& spheres, bool convex, SlotBlocks& sum) {
    const bool fed = yarn.supply == Supply::tension;
    for (std::size_t g = 0; g < gauss_points; ++g) {
        const Basis<double>& basis = gauss.basis[g];
        const Vec<double> at = combine(basis.value, slots), tangent = combine(basis.slope, slots);
        const double speed = guarded(tangent.norm(), yarn), weight = gauss.weight[g];
        const Vec<double> unit = tangent / speed;
        for (const Sphere<double>& sphere : spheres) {
            const SpherePush<double> push(sphere, at);
            if (push.depth <= 0 || push.distance <= 0) continue;
            const FieldCurvature<double> field =
                field_curvature(yarn, weight, speed, unit, sphere.stiffness, push, convex);
            sum.add(basis.value, basis.value, field.yy);
            if (!fed) continue;
            sum.add(basis.slope, basis.slope, field.tt);
            if (convex) continue;
            sum.add(basis.value, basis.slope, field.yt);
            sum.add(basis.slope, basis.value, field.yt.transpose());
        }
    }
}

}  // namespace weave::sim
