#include <weave/picture/space.hpp>

#include <algorithm>
#include <cmath>

namespace weave {

namespace {

constexpr double turn = 0.60, tilt = 0.56;  ///< radians: about the vertical, and down from the horizon

/// The points a little lengthened at both ends, so that pieces of one yarn join without a seam.
std::vector<Point> lengthened(std::vector<Point> points, double by) {
    const auto push = [by](Point& end, Point inner) {
        const double dx = end.x - inner.x, dy = end.y - inner.y, norm = std::hypot(dx, dy);
        if (norm > 0) end = {end.x + dx / norm * by, end.y + dy / norm * by};
    };
    push(points.front(), points[1]);
    push(points.back(), points[points.size() - 2]);
    return points;
}

}  // namespace

Point Viewpoint::on_screen(Place place) const {
    const double right = place.y * std::cos(turn) + place.x * std::sin(turn);
    const double away = place.x * std::cos(turn) - place.y * std::sin(turn);
    const double height = place.z * m_level;
    return {m_origin.x + m_scale * right,
            m_origin.y - m_scale * (away * std::sin(tilt) + height * std::cos(tilt))};
}

double Viewpoint::distance(Place place) const {
    const double away = place.x * std::cos(turn) - place.y * std::sin(turn);
    return away * std::cos(tilt) - place.z * m_level * std::sin(tilt);
}

void draw_tubes(Canvas& canvas, const Viewpoint& view, std::vector<Tube> tubes) {
    for (Tube& tube : tubes) tube.distance = view.distance(tube.places[tube.places.size() / 2]);
    std::ranges::stable_sort(tubes, std::greater{}, &Tube::distance);
    for (const Tube& tube : tubes) {
        std::vector<Point> points;
        for (const Place place : tube.places) points.push_back(view.on_screen(place));
        const double width = 2 * tube.radius;
        canvas.polyline(points,
                        {.colour = mix(tube.colour, {0, 0, 0}, 0.62), .width = width + 2, .round = false});
        points = lengthened(std::move(points), 0.7);
        canvas.polyline(points,
                        {.colour = mix(tube.colour, {0, 0, 0}, 0.18), .width = width, .round = false});
        for (Point& point : points) point.y -= tube.radius * 0.18;
        canvas.polyline(points, {.colour = tube.colour, .width = width * 0.62, .round = false});
        for (Point& point : points) point.y -= tube.radius * 0.14;
        canvas.polyline(
            points,
            {.colour = mix(tube.colour, {0xff, 0xff, 0xff}, 0.42), .width = width * 0.24, .round = false});
    }
}

}  // namespace weave
