#include <weave/curve/spline.hpp>
#include <weave/sim/linking.hpp>

#include <algorithm>
#include <cmath>

namespace weave::sim {

namespace {

constexpr int pieces_a_segment = 8;

struct Polyline {
    std::vector<Vec3> places;
    Vec3 low, high;
};

Polyline polyline_of(const Spline& spline) {
    Polyline line;
    const std::size_t pieces = pieces_a_segment * spline.segments();
    // Off the knots, so that a vertex on another yarn's straight line, which would count twice or not at all,
    // is rare.
    for (std::size_t k = 0; k <= pieces; ++k)
        line.places.push_back(spline.place(
            std::min(static_cast<double>(spline.segments()),
                     (static_cast<double>(k) + (spline.is_periodic ? 0.382 : 0)) / pieces_a_segment)));
    line.low = line.high = line.places.front();
    for (const Vec3& place : line.places) {
        line.low = line.low.cwiseMin(place);
        line.high = line.high.cwiseMax(place);
    }
    return line;
}

double turn(const Vec3& a, const Vec3& b) {
    return a.x() * b.y() - a.y() * b.x();
}

/// Signed crossings of two lines, the second moved.
int crossings(const Polyline& first, const Polyline& second, const Vec3& moved) {
    int sum = 0;
    for (std::size_t i = 0; i + 1 < first.places.size(); ++i) {
        const Vec3 &p = first.places[i], u = first.places[i + 1] - p;
        for (std::size_t j = 0; j + 1 < second.places.size(); ++j) {
            const Vec3 q = second.places[j] + moved, v = second.places[j + 1] - second.places[j], w = q - p;
            const double det = turn(u, v);
            if (det == 0) continue;
            const double along = turn(w, v) / det, other = turn(w, u) / det;
            if (along < 0 || along >= 1 || other < 0 || other >= 1) continue;
            const double height = p.z() + along * u.z() - q.z() - other * v.z();
            sum += (det > 0) == (height > 0) ? 1 : -1;
        }
    }
    return sum;
}

/// How many periods the second line may lie away and still overlap the first.
std::array<int, 2> images(const SimScene& scene, std::size_t axis, const Polyline& first,
                          const Polyline& second) {
    if (!scene.is_periodic[axis]) return {0, 0};
    const auto at = static_cast<Eigen::Index>(axis);
    return {static_cast<int>(std::ceil((first.low[at] - second.high[at]) / scene.period_mm[axis])),
            static_cast<int>(std::floor((first.high[at] - second.low[at]) / scene.period_mm[axis]))};
}

/// A yarn's own way on is no other strand: a loop that it lays in itself comes and goes freely.
bool is_same_strand(const SimYarn& yarn, int x, int y) {
    return (x == 0 && y == 0) || (yarn.is_periodic && x * yarn.turns[1] == y * yarn.turns[0]);
}

}  // namespace

std::vector<std::vector<int>> linking_of(const SimScene& scene,
                                         const std::vector<std::vector<Vec3>>& control) {
    std::vector<Polyline> lines;
    for (std::size_t y = 0; y < control.size(); ++y)
        lines.push_back(polyline_of({control[y], scene.yarns[y].is_periodic, scene.yarns[y].shift}));
    std::vector<std::vector<int>> linking(control.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
        linking[i].assign(i + 1, 0);
        for (std::size_t j = 0; j <= i; ++j) {
            const std::array<int, 2> x = images(scene, 0, lines[i], lines[j]),
                                     y = images(scene, 1, lines[i], lines[j]);
            for (int a = x[0]; a <= x[1]; ++a) {
                for (int b = y[0]; b <= y[1]; ++b) {
                    if (i == j && is_same_strand(scene.yarns[i], a, b)) continue;
                    linking[i][j] += crossings(lines[i], lines[j],
                                               Vec3(a * scene.period_mm[0], b * scene.period_mm[1], 0));
                }
            }
        }
    }
    return linking;
}

}  // namespace weave::sim
