#include <weave/picture/label_places.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace weave {

namespace {

/// What it costs to lie outside the picture, or over words, a disc, or a point of a line.
constexpr double outside_cost = 1e6, words_cost = 1e4, disc_cost = 100, line_cost = 5;
constexpr double line_margin = 3, step = 3;

bool overlap(const Rectangle& a, const Rectangle& b) {
    return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

double distance(const Rectangle& place, Point point) {
    const double x = std::max({place.x - point.x, 0.0, point.x - place.x - place.width}),
                 y = std::max({place.y - point.y, 0.0, point.y - place.y - place.height});
    return std::hypot(x, y);
}

bool holds(const Rectangle& whole, const Rectangle& part) {
    return part.x >= whole.x && part.y >= whole.y && part.x + part.width <= whole.x + whole.width &&
           part.y + part.height <= whole.y + whole.height;
}

Point on_curve(std::span<const Point> piece, double share) {
    const double rest = 1 - share;
    const double weights[] = {rest * rest * rest, 3 * rest * rest * share, 3 * rest * share * share,
                              share * share * share};
    Point point;
    for (std::size_t k = 0; k < 4; ++k)
        point.x += weights[k] * piece[k].x, point.y += weights[k] * piece[k].y;
    return point;
}

}  // namespace

void LabelPlaces::add_curve(std::span<const Point> bezier) {
    for (std::size_t k = 0; k + 3 < bezier.size(); k += 3) {
        const auto piece = bezier.subspan(k, 4);
        double length = 0;
        for (std::size_t i = 0; i < 3; ++i)
            length += std::hypot(piece[i + 1].x - piece[i].x, piece[i + 1].y - piece[i].y);
        const auto steps = static_cast<std::size_t>(length / step) + 1;
        for (std::size_t i = 0; i <= steps; ++i)
            m_lines.push_back(on_curve(piece, static_cast<double>(i) / static_cast<double>(steps)));
    }
}

double LabelPlaces::harm(const Rectangle& place) const {
    double cost = holds(m_within, place) ? 0 : outside_cost;
    for (const Rectangle& words : m_words) cost += overlap(place, words) ? words_cost : 0;
    for (const Disc& disc : m_discs) cost += distance(place, disc.centre) < disc.radius ? disc_cost : 0;
    for (const Point& point : m_lines) cost += distance(place, point) < line_margin ? line_cost : 0;
    return cost;
}

double LabelPlaces::harm_along(Point from, Point to) const {
    constexpr double width = 5;
    const auto steps = static_cast<std::size_t>(std::hypot(to.x - from.x, to.y - from.y) / step) + 1;
    double cost = 0;
    for (std::size_t k = 0; k <= steps; ++k) {
        const double share = static_cast<double>(k) / static_cast<double>(steps);
        const Point middle{from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)};
        cost += harm({middle.x - width / 2, middle.y - width / 2, width, width});
    }
    return cost;
}

bool LabelPlaces::fits(double width, double height, std::span<const Point> wishes) const {
    return std::ranges::any_of(wishes, [&](Point wish) {
        return harm({wish.x - width / 2, wish.y - height / 2, width, height}) == 0;
    });
}

Rectangle LabelPlaces::take(double width, double height, std::span<const Point> wishes) {
    Rectangle best;
    double least = std::numeric_limits<double>::infinity();
    for (const Point& wish : wishes) {
        const Rectangle place{wish.x - width / 2, wish.y - height / 2, width, height};
        const double cost = harm(place);
        if (cost >= least) continue;
        best = place, least = cost;
        if (cost == 0) break;
    }
    m_words.push_back(best);
    return best;
}

}  // namespace weave
