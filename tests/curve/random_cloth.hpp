#pragma once

#include "support/random.hpp"

#include <weave/design/design.hpp>

namespace weave::testing {

/// A design with random feeders, directions and boundaries around a random block: what wefts and rims can be.
inline Design random_plan(Random& random) {
    Design design;
    const std::size_t feeders = random.between(1, 3);
    design.weft.feeders.clear();
    for (std::uint32_t k = 0; k < feeders; ++k) design.weft.feeders.push_back({"feeder", 0});
    design.weft.feeder_order.clear();
    for (std::size_t k = random.between(1, 5); k > 0; --k) {
        FeederSet set{static_cast<std::uint32_t>(random.between(0, feeders - 1))};
        if (feeders > 1 && random.between(0, 5) == 0)
            set.push_back((set.front() + 1) % static_cast<std::uint32_t>(feeders));
        if (random.between(0, 9) == 0) set.clear();
        design.weft.feeder_order.push_back(set);
    }
    design.scene.boundary_x = random.coin() ? Boundary::periodic : Boundary::free;
    design.scene.boundary_y = random.coin() ? Boundary::periodic : Boundary::frozen;
    return design;
}

}  // namespace weave::testing
