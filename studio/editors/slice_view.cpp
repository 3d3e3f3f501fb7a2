#include <studio/editors/slice_view.hpp>

#include <algorithm>
#include <cmath>

namespace weave::studio {

QPointF SliceView::at(double position, double level) const {
    return {m_origin.x() + position * across(), m_origin.y() - level * up()};
}

std::optional<std::size_t> SliceView::column_at(double x, std::size_t positions) const {
    const double position = std::round(position_at(x));
    if (position < 0 || position >= static_cast<double>(positions)) return {};
    return static_cast<std::size_t>(position);
}

void SliceView::zoom_by(double factor, QPointF fixed) {
    const double position = position_at(fixed.x()), level = level_at(fixed.y());
    m_zoom = std::clamp(m_zoom * factor, least_zoom, most_zoom);
    m_origin += fixed - at(position, level);
}

void SliceView::fit(const SliceScene& scene, const QRectF& space) {
    const double positions = static_cast<double>(std::max<std::size_t>(scene.all_positions, 1)) + 3.4;
    const double levels = static_cast<double>(std::max<std::size_t>(scene.levels, 1)) + 1.2;
    m_zoom = 1;
    const double wide = space.width() / (positions * across()), high = space.height() / (levels * up());
    const double all = wide < 0.6 ? 1 : wide;  // rather a part that can be read
    m_zoom = std::clamp(std::min({all, high, 1.6}), 0.3, most_zoom);
    const double width = static_cast<double>(scene.all_positions) * across();
    const double left = std::max((space.width() - width) / 2 + across() / 2, 2.2 * across());
    const double height = (static_cast<double>(scene.levels) - 1) * up();
    m_origin = {space.left() + left, space.top() + (space.height() + height) / 2};
}

void SliceView::reveal(double position, double level, const QRectF& space) {
    const QPointF place = at(position, level);
    const double x = std::clamp(place.x(), space.left() + across(),
                                std::max(space.right() - across(), space.left() + across()));
    const double y =
        std::clamp(place.y(), space.top() + up(), std::max(space.bottom() - up(), space.top() + up()));
    move_by(QPointF(x, y) - place);
}

void SliceView::keep_in(const SliceScene& scene, const QRectF& space) {
    const QPointF low = at(0, 0),
                  high = at(static_cast<double>(std::max<std::size_t>(scene.all_positions, 1)) - 1,
                            static_cast<double>(std::max<std::size_t>(scene.levels, 1)) - 1);
    const double room = std::min(2.2 * across(), space.width() / 2);
    QPointF move;
    if (low.x() > space.right() - room) move.setX(space.right() - room - low.x());
    if (high.x() < space.left() + room) move.setX(space.left() + room - high.x());
    if (high.y() > space.bottom() - up()) move.setY(space.bottom() - up() - high.y());
    if (low.y() < space.top() + up()) move.setY(space.top() + up() - low.y());
    move_by(move);
}

QPainterPath curve_of(const SliceView& view, std::size_t first, const std::vector<double>& levels,
                      const std::vector<double>& aside, bool left_end, bool right_end) {
    const double begin = static_cast<double>(first), end = begin + static_cast<double>(levels.size()) - 1;
    QPainterPath curve(view.at(left_end ? begin - path_overhang : begin, levels.front()));
    if (left_end) curve.lineTo(view.at(begin, levels.front()));
    for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
        const double here = begin + static_cast<double>(k), step = k < aside.size() ? aside[k] : 0;
        curve.cubicTo(view.at(here + 0.5 + step, levels[k]), view.at(here + 0.5 + step, levels[k + 1]),
                      view.at(here + 1, levels[k + 1]));
    }
    if (right_end) curve.lineTo(view.at(end + path_overhang, levels.back()));
    return curve;
}

namespace {

/// Whether a path exchanges places with another one between a position and the next.
bool swaps_after(const SliceScene& scene, const ScenePath& path, std::size_t position) {
    const auto here = path.level_at(position), next = path.level_at(position + 1);
    return std::ranges::any_of(scene.paths, [&](const ScenePath& other) {
        const auto other_here = other.level_at(position), other_next = other.level_at(position + 1);
        return &other != &path && other_here && other_next && (*here < *other_here) != (*next < *other_next);
    });
}

double distance_to(const QPainterPath& curve, QPointF place) {
    double least = 1e9;
    for (const QPolygonF& line : curve.toSubpathPolygons()) {
        for (qsizetype k = 0; k + 1 < line.size(); ++k) {
            const QPointF along = line[k + 1] - line[k], away = place - line[k];
            const double length = QPointF::dotProduct(along, along);
            const double share =
                length > 0 ? std::clamp(QPointF::dotProduct(along, away) / length, 0.0, 1.0) : 0;
            const QPointF gap = away - share * along;
            least = std::min(least, std::hypot(gap.x(), gap.y()));
        }
    }
    return least;
}

}  // namespace

QPainterPath curve_of(const SliceView& view, const SliceScene& scene, const ScenePath& path, std::size_t from,
                      std::size_t to) {
    std::vector<double> levels, aside;
    for (std::size_t position = from; position <= to; ++position) {
        levels.push_back(static_cast<double>(path.levels[position - path.first]));
        if (position < to) aside.push_back(swaps_after(scene, path, position) ? path.shift * 0.55 : 0);
    }
    return curve_of(view, from, levels, aside, from == 0 && path.reaches_left,
                    to + 1 == scene.all_positions && path.reaches_right);
}

std::optional<std::size_t> path_at(const SliceView& view, const SliceScene& scene, QPointF place) {
    double least = std::max(view.path_width() * 1.3, 0.42 * view.up());
    std::optional<std::size_t> best;
    const double position = view.position_at(place.x());
    for (const ScenePath& path : scene.paths) {
        const double first = static_cast<double>(path.first), last = static_cast<double>(path.last());
        if (position < first - 1.6 || position > last + 1.6) continue;
        const double near = std::clamp(position, first, last);
        const auto from = static_cast<std::size_t>(std::max(first, std::floor(near) - 1));
        const auto to = static_cast<std::size_t>(std::min(last, std::floor(near) + 2));
        QPainterPath curve = curve_of(view, scene, path, from, to);
        if (from == path.first)
            curve.addPath(
                curve_of(view, path.first, {static_cast<double>(path.levels.front())}, {}, true, false));
        double away = distance_to(curve, place);
        const QPointF name = view.at(first - 1, static_cast<double>(path.levels.front()));
        if (std::abs(place.x() - name.x()) < 0.5 * view.across())
            away = std::min(away, std::abs(place.y() - name.y()));
        if (away >= least) continue;
        least = away;
        best = path.yarn.number;
    }
    return best;
}

std::optional<SliceYarnId> yarn_at(const SliceView& view, const SliceScene& scene, QPointF place) {
    for (const SceneDot& dot : scene.dot_list) {
        const QPointF away =
            place - view.at(static_cast<double>(dot.yarn.position), static_cast<double>(dot.level));
        if (std::hypot(away.x(), away.y()) <= view.radius() + 1) return dot.yarn;
    }
    if (const auto path = path_at(view, scene, place)) return SliceYarnId::run(*path);
    return {};
}

std::size_t dots_below(const SliceScene& scene, std::size_t position, double level) {
    return static_cast<std::size_t>(std::ranges::count_if(scene.dot_list, [&](const SceneDot& dot) {
        return dot.yarn.position == position && static_cast<double>(dot.level) < level;
    }));
}

const ScenePath* path_of(const SliceScene& scene, std::size_t number) {
    const auto found =
        std::ranges::find_if(scene.paths, [&](const ScenePath& path) { return path.yarn.number == number; });
    return found == scene.paths.end() ? nullptr : &*found;
}

const SceneDot* dot_of(const SliceScene& scene, const SliceYarnId& yarn) {
    const auto found = std::ranges::find(scene.dot_list, yarn, &SceneDot::yarn);
    return found == scene.dot_list.end() ? nullptr : &*found;
}

}  // namespace weave::studio
