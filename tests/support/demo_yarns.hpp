#pragma once

#include <weave/sim/yarns.hpp>

#include <cmath>
#include <numbers>

namespace weave::testing {

/// The spline through these places, one control point each, found by repeated correction: enough for tests.
inline Spline spline_through(const std::vector<Vec3>& places, bool is_periodic, const Vec3& shift) {
    Spline spline{places, is_periodic, shift};
    for (int turn = 0; turn < 60; ++turn) {
        const Spline before = spline;
        for (std::size_t i = 0; i < places.size(); ++i)
            spline.control[i] += places[i] - before.place(static_cast<double>(i));
    }
    return spline;
}

/// How high a yarn lies at a crossing, from -1 to 1, in units of its swing.
using Height = double (*)(std::size_t yarn, std::size_t crossing);

struct DemoSystem {
    System system = System::weft;
    std::size_t count = 8, crossings = 8;
    double pitch_mm = 0.5, crossing_pitch_mm = 0.5, radius_mm = 0.12, swing_mm = 0.12;
    double level_mm = 0;
    Colour colour;
};

/// Adds yarns that swing between their crossings, eight points each pitch of two crossings; periodic.
inline void add_yarns(Yarns& yarns, const DemoSystem& system, Height height) {
    const bool is_warp = system.system == System::warp;
    const double length = static_cast<double>(system.crossings) * system.crossing_pitch_mm;
    for (std::size_t number = 0; number < system.count; ++number) {
        std::vector<Vec3> places, planned;
        for (std::size_t k = 0; k < 2 * system.crossings; ++k) {
            const double at = static_cast<double>(k) / 2;
            const double here = height(number, k / 2), next = height(number, (k / 2 + 1) % system.crossings);
            const double z = system.level_mm + system.swing_mm * (k % 2 == 0 ? here : (here + next) / 2);
            const double along = at * system.crossing_pitch_mm,
                         across = static_cast<double>(number) * system.pitch_mm;
            places.push_back(is_warp ? Vec3(along, across, z) : Vec3(across, along, z));
            planned.push_back({places.back().x(), places.back().y(), system.level_mm});
        }
        SimulatedYarn yarn;
        yarn.system = system.system;
        yarn.number = 0;
        for (const SimulatedYarn& other : yarns.yarns) yarn.number += other.system == system.system ? 1 : 0;
        yarn.radius_mm = system.radius_mm;
        yarn.colour = system.colour;
        yarn.spline = spline_through(places, true, is_warp ? Vec3(length, 0, 0) : Vec3(0, length, 0));
        yarn.planned = planned;
        for (std::size_t k = 0; k < places.size(); ++k) {
            yarn.strain.push_back(0.01 + 0.02 * std::sin(0.7 * static_cast<double>(k + number)));
            yarn.contact_N.push_back(k % 2 == 0 ? 0.4 + 0.05 * static_cast<double>(number) : 0.02);
        }
        yarn.planned_length_mm = length;
        yarn.length_mm = 1.1 * length;
        yarn.rest_length_mm = 1.05 * length;
        yarns.yarns.push_back(yarn);
    }
}

/// One layer of plain weave, 8 × 8, relaxed as far as cosines go; every weft crosses every warp.
inline Yarns plain_weave() {
    Yarns yarns;
    yarns.title = "Plain weave, 8 × 8";
    yarns.size_mm = {4, 4};
    yarns.is_periodic = {true, true};
    yarns.region = {0, 7, 0, 7};
    yarns.cloth_rows = yarns.cloth_columns = 8;
    DemoSystem system;
    system.colour = {0x30, 0x60, 0xa0};
    add_yarns(yarns, system, [](std::size_t a, std::size_t b) { return (a + b) % 2 == 0 ? 1.0 : -1.0; });
    system.system = System::warp;
    system.colour = {0xd8, 0x50, 0x30};
    add_yarns(yarns, system, [](std::size_t a, std::size_t b) { return (a + b) % 2 == 0 ? -1.0 : 1.0; });
    for (std::size_t pick = 0; pick < 8; ++pick) {
        for (std::size_t end = 0; end < 8; ++end)
            yarns.crossings.push_back({pick, end, 8 + end, pick, pick, end, (pick + end) % 2 == 0});
    }
    yarns.report = {{"solver", "none"}, {"residual", 0.001}};
    return yarns;
}

/// Three layers of straight wefts with binders that run through all of them, in the colours of nobody's
/// choice.
inline Yarns interlock(Colour weft, Colour warp) {
    Yarns yarns;
    yarns.title = "Interlock in three layers";
    yarns.size_mm = {8 * 0.7, 8 * 0.3};
    yarns.is_periodic = {true, true};
    yarns.region = {0, 7, 0, 7};
    yarns.cloth_rows = yarns.cloth_columns = 8;
    for (const double level : {-0.52, 0.0, 0.52}) {
        DemoSystem wefts{System::weft, 8, 8, 0.7, 0.3, 0.17, 0.02, level, weft};
        add_yarns(yarns, wefts, [](std::size_t a, std::size_t b) { return (a + b) % 2 == 0 ? 1.0 : -1.0; });
    }
    DemoSystem warps{System::warp, 8, 8, 0.3, 0.7, 0.09, 0.80, 0, warp};
    add_yarns(yarns, warps, [](std::size_t a, std::size_t b) {
        constexpr double wave[]{1, 0.33, -0.33, -1, -1, -0.33, 0.33, 1};
        return wave[(3 * a + b) % 8];
    });
    return yarns;
}

}  // namespace weave::testing
