#pragma once

// How near yarns may come in one step without passing through one another.

#include <weave/sim/bodies.hpp>

#include <Eigen/Geometry>

#include <cmath>

namespace weave::sim {

/// Share of their distance by which yarns may come closer in one step: below a half, so that both may.
inline constexpr double closest = 0.45;

/// Rounds in which a change is shortened where it is not safe: in the gentle ones yarns that are pressed together lose only what would bring them nearer, and the rest
/// moves less; after them what is not safe `enough` does not move at all.
struct ShorteningRounds {
    static constexpr int gentle = 6, most = 20;
    static constexpr double enough = 0.9;
};

/// What of `apart` is across two nearly parallel directions, the same whichever of them comes first.
template <class Real>
WEAVE_HD inline Vec<Real> away_from(const Vec<Real>& apart, const Vec<Real>& along, const Vec<Real>& other) {
    const Real turn = along.dot(other) < 0 ? Real(-1) : Real(1);
    const Vec<Real> both = along / along.norm() + turn * other / other.norm();
    return apart - both * (both.dot(apart) / both.squaredNorm());
}

/// Two samples that lie deep in one another. Such yarns may pass between their samples: there it counts how far apart the straight
/// lines through two samples are, if these lie about where the lines are nearest.
template <class Real>
struct CrossingLines {
    Vec<Real> across = Vec<Real>::Zero();  ///< both yarns, of any length; zero where the lines say nothing
    double size = 0;                       ///< of `across`
    double height = 0;                     ///< of the first sample over the other, that way, mm

    /// `apart`: from the other sample, which has the tangent `other`, to the first. `is_one_yarn`: of which both are samples; where they
    /// lie behind one another on it nothing crosses, however little room a yarn that is pushed together leaves them.
    WEAVE_HD static CrossingLines of(const Vec<Real>& along, const Vec<Real>& other, const Vec<Real>& apart, Real reach, bool is_one_yarn) {
        constexpr double beside = 0.3, behind = 0.1, least_sine = 0.1, least_segment = 0.1;
        // Segments as short as that have samples so close that nothing passes between them, and tangents that say little.
        const Real along2 = along.squaredNorm(), other2 = other.squaredNorm();
        const auto shortest = static_cast<double>(along2 < other2 ? along2 : other2);
        if (shortest < least_segment * least_segment * static_cast<double>(reach * reach)) return {};
        Vec<Real> across = along.cross(other);
        if (across.squaredNorm() < Real(least_sine * least_sine) * along2 * other2) {
            across = away_from(apart, along, other);
            if (is_one_yarn && across.squaredNorm() < Real(behind * behind) * apart.squaredNorm()) return {};
        }
        const auto size = static_cast<double>(across.norm());
        if (!(size > 0)) return {};
        const double height = static_cast<double>(apart.dot(across)) / size,
                     aside2 = static_cast<double>(apart.squaredNorm()) - height * height,
                     most = beside * static_cast<double>(reach);
        if (aside2 >= most * most) return {};
        return {across, size, height};
    }

    /// By how much a change of `apart` brings the lines nearer, mm; 0 where it does not.
    [[nodiscard]] WEAVE_HD double closing(const Vec<Real>& change) const {
        if (!(size > 0)) return 0;
        const double rise = static_cast<double>(change.dot(across)) / size, falls = height < 0 ? rise : -rise;
        return height != 0 && falls > 0 ? falls : 0;
    }

    /// Nearer than the lines stand for the curves they do not come at all, whatever presses the yarns together.
    [[nodiscard]] WEAVE_HD bool is_pressed(Real reach) const {
        constexpr double least_height = 0.02;
        return size > 0 && (height < 0 ? -height : height) < least_height * static_cast<double>(reach);
    }

    /// What share of such a change the two may go; 1e300: any.
    [[nodiscard]] WEAVE_HD double share(const Vec<Real>& change, Real reach) const {
        constexpr double any = 1e300;
        const double nearer = closing(change);
        if (!(nearer > 0)) return any;
        return is_pressed(reach) ? 0 : closest * ((height < 0 ? -height : height) / nearer);
    }

    /// What of `mine`, the change of a slot that the first sample follows, brings the two no nearer where they move by `moved` and
    /// `theirs`: across both yarns it goes at least as far as the two do on the mean, along them as it did. A sample moves as its
    /// slots do on the mean; so where those of both keep to this, the two stay as near as they are, or part by a millionth, lest
    /// rounding bring them nearer.
    [[nodiscard]] WEAVE_HD Vec<Real> without_closing(const Vec<Real>& mine, const Vec<Real>& moved, const Vec<Real>& theirs) const {
        constexpr Real parting = Real(1e-6);
        const Vec<Real> away = across * (height < 0 ? Real(-1 / size) : Real(1 / size));
        const Real least = (moved + theirs).dot(away) / 2 + parting * (moved - theirs).norm(), has = mine.dot(away);
        return has < least ? Vec<Real>(mine + (least - has) * away) : mine;
    }
};

}  // namespace weave::sim
