#pragma once

#include <weave/sim/yarns.hpp>

#include <cstddef>

namespace weave::testing {

/// A yarn of radius 0.5 mm from one place to another that nobody relaxed, strained at its end and pressed by 2 N.
inline SimulatedYarn straight_yarn(System system, std::size_t number, const Vec3& from, const Vec3& to, Colour colour) {
    SimulatedYarn yarn;
    yarn.system = system;
    yarn.number = number;
    yarn.radius_mm = 0.5;
    yarn.colour = colour;
    yarn.spline.control = {from, to};
    yarn.planned = yarn.spline.control;
    yarn.strain = {0, 0.1};
    yarn.contact_N = {2, 2};
    return yarn;
}

}  // namespace weave::testing
