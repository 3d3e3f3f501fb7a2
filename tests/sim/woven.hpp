#pragma once

#include <weave/sim/yarns.hpp>

#include <cmath>
#include <support/demo_yarns.hpp>

namespace weave::sim::testing {

/// A cloth of straight yarns, periodic both ways: in each of `rows` rows `layers` picks above one another,
/// and a column of as many ends between them, end l below pick l. Two control points a crossing, one key a
/// crossing.
struct StraightCloth {
    std::size_t rows = 4, columns = 4, layers = 3;
    double pitch_mm = 1, level_mm = 0.5, radius_mm = 0.1;
    /// The card: whether pick `layer` of `row` lies over end `other` of `column`.
    bool (*over)(std::size_t layer, std::size_t other, std::size_t row, std::size_t column) =
        [](std::size_t layer, std::size_t other, std::size_t, std::size_t) { return layer >= other; };
};

inline SimulatedYarn straight_yarn(System system, std::size_t number, const Vec3& from, std::size_t crossings,
                                   double pitch, double radius) {
    SimulatedYarn yarn;
    yarn.system = system;
    yarn.number = number;
    yarn.radius_mm = radius;
    const Vec3 step = system == System::warp ? Vec3(pitch, 0, 0) : Vec3(0, pitch, 0);
    for (std::size_t k = 0; k < 2 * crossings; ++k)
        yarn.spline.control.push_back(from + 0.5 * static_cast<double>(k) * step);
    yarn.spline.is_periodic = true;
    yarn.spline.shift = static_cast<double>(crossings) * step;
    yarn.planned = yarn.spline.control;
    yarn.strain.assign(yarn.planned.size(), 0.01);
    yarn.contact_N.assign(yarn.planned.size(), 0);
    yarn.planned_length_mm = yarn.length_mm = yarn.rest_length_mm = yarn.spline.shift.norm();
    return yarn;
}

inline Yarns straight_cloth(const StraightCloth& wish) {
    Yarns yarns;
    yarns.title = "straight";
    const auto place = [&](std::size_t k) { return static_cast<double>(k) * wish.pitch_mm; };
    for (std::size_t row = 0; row < wish.rows; ++row) {
        for (std::size_t l = 0; l < wish.layers; ++l)
            yarns.yarns.push_back(
                straight_yarn(System::weft, row * wish.layers + l,
                              Vec3(place(row), 0, (static_cast<double>(l) + 0.25) * wish.level_mm),
                              wish.columns, wish.pitch_mm, wish.radius_mm));
    }
    for (std::size_t column = 0; column < wish.columns; ++column) {
        for (std::size_t l = 0; l < wish.layers; ++l)
            yarns.yarns.push_back(
                straight_yarn(System::warp, column * wish.layers + l,
                              Vec3(0, place(column), (static_cast<double>(l) - 0.25) * wish.level_mm),
                              wish.rows, wish.pitch_mm, wish.radius_mm));
    }
    const std::size_t picks = wish.rows * wish.layers;
    for (std::size_t pick = 0; pick < picks; ++pick) {
        for (std::size_t end = 0; end < wish.columns * wish.layers; ++end)
            yarns.crossings.push_back(
                {pick, end / wish.layers, picks + end, pick / wish.layers, pick, end,
                 wish.over(pick % wish.layers, end % wish.layers, pick / wish.layers, end / wish.layers)});
    }
    yarns.size_mm = {place(wish.rows), place(wish.columns)};
    yarns.is_periodic = {true, true};
    yarns.region = {0, wish.rows - 1, 0, wish.columns - 1};
    yarns.cloth_rows = wish.rows;
    yarns.cloth_columns = wish.columns;
    yarns.report = {{"points_per_key", 2},
                    {"converged", true},
                    {"order_kept", true},
                    {"residual", 1e-3},
                    {"max_overlap", 0.1}};
    return yarns;
}

inline void shift(SimulatedYarn& yarn, const Vec3& by) {
    for (Vec3& place : yarn.spline.control) place += by;
}

/// Length of a spline by its chords, to about a millionth.
inline double length_of(const Spline& spline) {
    double length = 0;
    const std::size_t looks = 256 * spline.segments();
    for (std::size_t k = 0; k < looks; ++k)
        length +=
            (spline.place(static_cast<double>(k + 1) / 256) - spline.place(static_cast<double>(k) / 256))
                .norm();
    return length;
}

}  // namespace weave::sim::testing
