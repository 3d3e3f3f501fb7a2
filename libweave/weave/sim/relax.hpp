#pragma once

#include <weave/sim/energy.hpp>
#include <weave/sim/hessian.hpp>
#include <weave/sim/newton.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

namespace weave::sim {

/// How far a relaxation has come.
struct Progress {
    std::size_t iteration = 0;
    double residual = 0;  ///< max |P∇E| / F_ref
    double energy = 0;    ///< N·mm
    double seconds = 0;
    /// Crossings that do not lie as the card says, as simulate() saw them when it looked last (order_watch.hpp); nothing
    /// before its first look, and from solvers alone.
    std::optional<std::size_t> lost_crossings = {};
};

struct RelaxOptions {
    double residual = 1e-3;  ///< goal
    std::size_t most_iterations = 5000;
    double most_seconds = 1e30;
    bool leaves_saddles = true;  ///< a rest that is no minimum is not taken for one
    /// Called after every iteration; false stops with the last state kept.
    std::function<bool(const Progress&)> watch;
};

/// One of many cloths that are relaxed next to one another.
struct ClothToRelax {
    Energy<double>* energy;
    std::vector<double>* state;
    RelaxOptions options;
};

enum class Ending : std::uint8_t { converged, stopped, iterations, time, stuck };

/// `converged` and so on, as reports write it.
std::string_view name_of(Ending ending);

struct RelaxResult {
    Ending ending = Ending::converged;
    double residual = 0, energy = 0, reference_N = 0;
    std::size_t iterations = 0, evaluations = 0, cg_iterations = 0, builds = 0;
    double seconds = 0;
    /// At rest: whether the energy curves downwards in some direction there, by too little to leave it
    /// (bend_at() says whether the rest is a saddle); nothing where that was not looked at.
    std::optional<bool> curves_down;
    std::vector<Progress> history;
};

/// The greatest of warp tension, EI/L² and 1e-6·EA, in N; 0 for an empty scene.
double force_of_yarns(const SimScene& scene);

/// Greatest strain of yarns of fixed length, each taken as a whole.
template <class Real>
double greatest_strain(const Fabric<Real>& fabric, const std::vector<Real>& state);

/// The force that residuals are measured by: that of the yarns, or the median contact force of the points that are touched where
/// that is greater.
template <class Real>
double reference_force(Energy<Real>& energy, const std::vector<Real>& state);

/// Greatest |gradient| of a control point, N.
template <class Real>
double greatest_force(const Executor& executor, const std::vector<Real>& gradient);

/// Relaxes to an equilibrium: by steps that learn from the energy's history far from rest (descent.hpp), by Newton's in a
/// trust region near it or where the others stall (newton.hpp). No step lets yarns pass through one another.
template <class Real>
RelaxResult relax(Energy<Real>& energy, std::vector<Real>& state, const RelaxOptions& options);

/// Whether a state of rest is a saddle, as a search of 80 conjugate gradient steps with the exact second derivatives finds
/// it. The curvature at a state is not that of the rest it is near: a saddle is claimed only where the energy falls to both
/// sides, on the mean (to which the gradient gives nothing) by more than against a hundredth of `force`, N, which is what
/// counts as none.
template <class Real>
Bend bend_at(Energy<Real>& energy, const std::vector<Real>& state, double force);

}  // namespace weave::sim
