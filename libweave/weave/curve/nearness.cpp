#include <weave/curve/nearness.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace weave {

namespace {

/// Halving any further changes no place that can be told apart.
constexpr int deepest = 40;

/// How far a piece can be from its chord, both run through from 0 to 1: the inner Bézier points' distances
/// from where a straight piece has them, times the greatest sum of their weights, 3/4.
double stray(const CubicPiece& p) {
    const double first = (p[1] - (2 * p[0] + p[3]) / 3).squaredNorm(),
                 second = (p[2] - (p[0] + 2 * p[3]) / 3).squaredNorm();
    return 0.75 * std::sqrt(std::max(first, second));
}

Vec3 place_on(const CubicPiece& p, double t) {
    const double s = 1 - t;
    return s * s * (s * p[0] + 3 * t * p[1]) + t * t * (3 * s * p[2] + t * p[3]);
}

/// Parameters of the nearest points of two straight stretches (after Ericson, Real-Time Collision Detection,
/// 5.1.9). Any point of either may have length 0, and they may be parallel.
std::pair<double, double> nearest(const Vec3& p, const Vec3& p_end, const Vec3& q, const Vec3& q_end) {
    const Vec3 d = p_end - p, e = q_end - q, r = p - q;
    const double dd = d.squaredNorm(), ee = e.squaredNorm(), er = e.dot(r), dr = d.dot(r);
    if (dd == 0 && ee == 0) return {0, 0};
    if (dd == 0) return {0, std::clamp(er / ee, 0.0, 1.0)};
    if (ee == 0) return {std::clamp(-dr / dd, 0.0, 1.0), 0};
    const double de = d.dot(e), determinant = dd * ee - de * de;
    double s = determinant > 1e-14 * dd * ee ? std::clamp((de * er - dr * ee) / determinant, 0.0, 1.0) : 0;
    double t = (de * s + er) / ee;
    if (t < 0 || t > 1) {
        t = std::clamp(t, 0.0, 1.0);
        s = std::clamp((de * t - dr) / dd, 0.0, 1.0);
    }
    return {s, t};
}

bool search(const CubicPiece& a, const CubicPiece& b, Nearness& best, int depth) {
    const auto [s, t] = nearest(a[0], a[3], b[0], b[3]);
    const double chords = (a[0] + s * (a[3] - a[0]) - b[0] - t * (b[3] - b[0])).norm();
    const double stray_a = stray(a), stray_b = stray(b);
    if (chords - stray_a - stray_b >= best.distance) return false;
    bool nearer = false;
    const Vec3 on_a = place_on(a, s), on_b = place_on(b, t);
    if (const double distance = (on_a - on_b).norm(); distance < best.distance) {
        best = {distance, (on_a + on_b) / 2};
        nearer = true;
    }
    if (depth == deepest || stray_a + stray_b <= 1e-4 * best.distance) return nearer;
    if (stray_a >= stray_b) {
        for (const CubicPiece& half : halves(a)) nearer |= search(half, b, best, depth + 1);
    } else {
        for (const CubicPiece& half : halves(b)) nearer |= search(a, half, best, depth + 1);
    }
    return nearer;
}

bool stays_off(const CubicPiece& piece, double distance, int depth) {
    const Vec3 from = piece[0], step = piece[3] - piece[0];
    const double length = step.squaredNorm(),
                 t = length == 0 ? 0 : std::clamp(-from.dot(step) / length, 0.0, 1.0);
    if ((from + t * step).norm() - stray(piece) > distance) return true;
    if (depth == deepest || place_on(piece, t).norm() <= distance) return false;
    const auto [first, second] = halves(piece);
    return stays_off(first, distance, depth + 1) && stays_off(second, distance, depth + 1);
}

}  // namespace

std::array<CubicPiece, 2> halves(const CubicPiece& p) {
    const Vec3 ab = (p[0] + p[1]) / 2, bc = (p[1] + p[2]) / 2, cd = (p[2] + p[3]) / 2;
    const Vec3 abc = (ab + bc) / 2, bcd = (bc + cd) / 2, middle = (abc + bcd) / 2;
    return {CubicPiece{p[0], ab, abc, middle}, CubicPiece{middle, bcd, cd, p[3]}};
}

bool bring_nearer(const CubicPiece& a, const CubicPiece& b, Nearness& best) {
    return search(a, b, best, 0);
}

bool stays_off_axis(const CubicPiece& piece, double distance) {
    CubicPiece flat = piece;
    for (Vec3& point : flat) point.x() = 0;
    return stays_off(flat, distance, 0);
}

}  // namespace weave
