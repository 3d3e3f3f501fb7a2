#pragma once

#include <weave/sim/yarns_file.hpp>
#include <weave/wire/message.hpp>

#include <catch2/catch.hpp>

#include <string>

namespace weave::simd::testing {

/// A cloth, and a run of it that takes some seconds and several legs to come to rest.
inline constexpr const char* long_cloth = "hexagon-tubes";
inline wire::Simulation long_run() {
    wire::Simulation simulation;
    simulation.plan.fidelity = sim::Fidelity::standard;
    simulation.residual = 1e-4;
    return simulation;
}

/// What must be the same of two results of one run: the yarns to the last bit, and how they came to rest.
inline void check_same_yarns(const std::string& one_bytes, const std::string& other_bytes) {
    const Yarns one = read_yarns(one_bytes).value(), other = read_yarns(other_bytes).value();
    REQUIRE(one.yarns.size() == other.yarns.size());
    std::size_t different = 0;
    for (std::size_t y = 0; y < one.yarns.size(); ++y) {
        different += one.yarns[y].spline.control == other.yarns[y].spline.control ? 0 : 1;
        different += one.yarns[y].radius_mm == other.yarns[y].radius_mm ? 0 : 1;
    }
    CHECK(different == 0);
    for (const char* member : {"iterations", "residual", "energy_N_mm", "converged", "scene_sha256", "design_sha256"}) {
        INFO(member);
        CHECK(one.report.at(member) == other.report.at(member));
    }
}

}  // namespace weave::simd::testing
