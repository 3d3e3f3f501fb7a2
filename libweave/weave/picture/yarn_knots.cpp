#include <weave/picture/yarn_knots.hpp>

#include <weave/curve/drawn_by.hpp>
#include <weave/design/yarns.hpp>
#include <weave/picture/look.hpp>
#include <weave/sim/sampled.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace weave {

double value_of(const SimulatedYarn& yarn, const Spline& planned, ClothColour colour, double t) {
    switch (colour) {
        case ClothColour::strain:
            return 100 * value_at(yarn.spline, yarn.strain, t);
        case ClothColour::contact:
            return value_at(yarn.spline, yarn.contact_N, t);
        case ClothColour::moved:
            return (yarn.spline.place(t) - planned.place(t)).norm();
        case ClothColour::height:
            return yarn.spline.place(t).z();
        case ClothColour::yarn:
            break;
    }
    return 0;
}

std::vector<YarnKnot> knots_of(const SimulatedYarn& yarn, const std::vector<double>& parameters,
                               ClothColour colour) {
    const Spline planned{yarn.planned, yarn.spline.is_periodic, yarn.spline.shift};
    std::vector<YarnKnot> knots;
    knots.reserve(parameters.size());
    Vec3 tangent(1, 0, 0);
    for (const double t : parameters) {
        const Vec3 way = yarn.spline.tangent(t);
        if (way.norm() > 0) tangent = way.normalized();
        const Vec3 place = yarn.spline.place(t);
        const double along = knots.empty() ? 0 : knots.back().along + (place - knots.back().place).norm();
        knots.push_back({place, tangent, value_of(yarn, planned, colour, t), along});
    }
    return knots;
}

std::vector<Colour> own_colours(const Yarns& yarns) {
    const Colour plain_warp = default_warp().yarns[0].colour, plain_weft = default_weft().yarns[0].colour;
    const auto chosen = [&](System system, Colour plain) {
        return std::ranges::any_of(yarns.yarns, [&](const SimulatedYarn& yarn) {
            return yarn.system == system && yarn.colour != plain;
        });
    };
    const bool own_warp = chosen(System::warp, plain_warp), own_weft = chosen(System::weft, plain_weft);
    std::vector<Colour> colours;
    for (const SimulatedYarn& yarn : yarns.yarns) {
        const bool is_warp = yarn.system == System::warp;
        colours.push_back(is_warp    ? (own_warp ? yarn.colour : paper_warp)
                          : own_weft ? yarn.colour
                                     : paper_weft);
    }
    return colours;
}

namespace {

/// Whether the curve at a control point is drawn by points that all left their planned place: a held one never does.
bool is_free_at(const SimulatedYarn& yarn, std::size_t point) {
    const std::vector<Vec3>& control = yarn.spline.control;
    return !any_that_draws(control.size(), yarn.spline.is_periodic, point, [&](std::size_t at) { return control[at] == yarn.planned[at]; });
}

/// Least and greatest strain of what is not held, %; nothing where all is.
std::optional<ValueRange> free_strain(const Yarns& yarns) {
    std::optional<ValueRange> range;
    for (const SimulatedYarn& yarn : yarns.yarns) {
        for (std::size_t i = 0; i < yarn.strain.size(); ++i) {
            if (!is_free_at(yarn, i)) continue;
            const double strain = 100 * yarn.strain[i];
            if (!range) range = ValueRange{strain, strain};
            range->low = std::min(range->low, strain);
            range->high = std::max(range->high, strain);
        }
    }
    return range;
}

}  // namespace

ValueRange scale_of(const Yarns& yarns, ClothColour colour, double least, double most) {
    if (const auto range = colour == ClothColour::strain ? free_strain(yarns) : std::nullopt) {
        least = std::max(least, range->low);
        most = std::min(most, range->high);
    }
    const bool has_zero = colour != ClothColour::strain && colour != ClothColour::height;
    const double low = has_zero ? 0 : least;
    const double thinnest = 1e-9 + 1e-6 * std::max(std::abs(low), std::abs(most));
    return {low, std::max(most, low + thinnest)};
}

ColourWords words_of(ClothColour colour) {
    switch (colour) {
        case ClothColour::strain:
            return {"strain", "strain, %"};
        case ClothColour::contact:
            return {"contact force", "contact, N"};
        case ClothColour::moved:
            return {"distance from the planned place", "moved, mm"};
        case ClothColour::height:
            return {"height", "height, mm"};
        case ClothColour::yarn:
            break;
    }
    return {"yarn", ""};
}

}  // namespace weave
