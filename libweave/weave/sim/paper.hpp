#pragma once

#include <weave/sim/relax.hpp>

#include <cstdint>

namespace weave::sim {

/// How the rest lengths of yarns fed at constant tension follow their lengths.
enum class Balance : std::uint8_t {
    tension,      ///< an energy, the one that `relax` minimises: T·l and an even parameter (bodies.hpp)
    rest_length,  ///< the paper's update (section 5.1): L = l/S of every segment at every step; no energy has
                  ///< these forces
};

struct PaperOptions {
    /// Time step as a share of the stability limit 2/ω, with ω the highest frequency of the yarns as they
    /// lie.
    double step = 0.9;
    /// Share of the velocity that is lost in a step as long as that limit.
    double damping = 0.03;
    Balance balance = Balance::tension;
};

/// The paper's solver (section 5 and A.4), the baseline that others are measured against: the yarns move in
/// time by symplectic Euler, v += -Δt·M⁻¹∇E and q += Δt·v, with damping in proportion to mass. M is the
/// yarns' own mass, evenly over their control points (a yarn without mass moves as one of 1 g/cm³ would);
/// what is frozen has an inverse mass of 0. The step adapts: its limit is measured by power iteration
/// whenever forces have changed. A step that could bring yarns through one another is shortened where it
/// would, and those points lose the velocity that they do not use.
///
/// It ends like relax(): by the residual, and with the last state kept. Of Balance::rest_length the residual
/// is that of the forces that it uses. Ending::stuck means that forces grew without limit.
template <class Real>
RelaxResult relax_in_time(Energy<Real>& energy, std::vector<Real>& state, const RelaxOptions& options,
                          const PaperOptions& paper = {});

}  // namespace weave::sim
