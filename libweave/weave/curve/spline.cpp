#include <weave/curve/spline.hpp>

#include <weave/curve/wrapped.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace weave {

namespace {

/// Solves (x[i-1] + 4 x[i] + x[i+1]) / 6 = b[i] for i = 0 … n-1 in place, where x[-1] and x[n] are `before`
/// and `after` (Thomas' algorithm; the matrix is diagonally dominant, so no pivoting is needed).
template <class T>
void solve_open(std::vector<T>& b, const T& before, const T& after) {
    const std::size_t n = b.size();
    if (n == 0) return;
    std::vector<double> c(n);
    for (T& value : b) value *= 6;
    b.front() -= before;
    b.back() -= after;
    c[0] = 0.25;
    b[0] *= 0.25;
    for (std::size_t i = 1; i < n; ++i) {
        c[i] = 1 / (4 - c[i - 1]);
        b[i] = (b[i] - b[i - 1]) * c[i];
    }
    for (std::size_t i = n - 1; i-- > 0;) b[i] -= c[i] * b[i + 1];
}

/// The same on a ring, x[i + n] = x[i]: the last unknown is taken out of the ring and found from its own
/// equation, as all others are linear in it.
void solve_ring(std::vector<Vec3>& b) {
    const std::size_t n = b.size();
    if (n == 1) return;
    if (n == 2) {
        const Vec3 sum = b[0] + b[1], difference = 3 * (b[0] - b[1]);
        b[0] = (sum + difference) / 2;
        b[1] = (sum - difference) / 2;
        return;
    }
    const Vec3 last = b.back();
    std::vector<Vec3> rest(b.begin(), b.end() - 1);
    std::vector<double> answer(n - 1, 0.0);  // of the others to the last one being 1
    solve_open<Vec3>(rest, Vec3::Zero(), Vec3::Zero());
    solve_open<double>(answer, 1.0, 1.0);
    const Vec3 x = (6 * last - rest.front() - rest.back()) / (4 + answer.front() + answer.back());
    for (std::size_t i = 0; i + 1 < n; ++i) b[i] = rest[i] + answer[i] * x;
    b.back() = x;
}

/// Segment and place within it of a parameter.
std::pair<std::ptrdiff_t, double> locate(const Spline& spline, double t) {
    double segment = std::floor(t);
    if (!spline.is_periodic) {
        const auto last = static_cast<double>(spline.segments()) - 1;
        segment = std::clamp(segment, 0.0, std::max(last, 0.0));
    }
    return {static_cast<std::ptrdiff_t>(segment), t - segment};
}

/// The four control points of a segment under four weights.
Vec3 weighted(const Spline& spline, std::ptrdiff_t segment, const std::array<double, 4>& weights) {
    Vec3 sum = Vec3::Zero();
    // Far from the ends, where most are, they lie side by side: no index needs to be looked at.
    const auto count = static_cast<std::ptrdiff_t>(spline.control.size());
    if (segment >= 1 && segment + 2 < count) {
        const Vec3* control = &spline.control[static_cast<std::size_t>(segment) - 1];
        for (std::size_t k = 0; k < 4; ++k) sum += weights[k] * control[k];
        return sum;
    }
    for (std::ptrdiff_t k = 0; k < 4; ++k)
        sum += weights[static_cast<std::size_t>(k)] * spline.at(segment - 1 + k);
    return sum;
}

bool is_point(const Spline& spline) {
    return !spline.is_periodic && spline.control.size() == 1;
}

}  // namespace

Vec3 Spline::at(std::ptrdiff_t index) const {
    const auto n = static_cast<std::ptrdiff_t>(control.size());
    assert(n > 0);
    if (index >= 0 && index < n) return control[static_cast<std::size_t>(index)];
    if (is_periodic) {
        const Wrapped there = wrapped(index, n);
        return control[static_cast<std::size_t>(there.index)] + static_cast<double>(there.round) * shift;
    }
    if (n == 1) return control.front();
    if (index < 0) return control.front() + static_cast<double>(index) * (control[1] - control[0]);
    const Vec3 step = control.back() - control[control.size() - 2];
    return control.back() + static_cast<double>(index - n + 1) * step;
}

Vec3 Spline::place(double t) const {
    if (is_point(*this)) return control.front();
    const auto [segment, u] = locate(*this, t);
    const double v = 1 - u;
    return weighted(
        *this, segment,
        {v * v * v / 6, (4 + u * u * (3 * u - 6)) / 6, (4 + v * v * (3 * v - 6)) / 6, u * u * u / 6});
}

Vec3 Spline::tangent(double t) const {
    if (is_point(*this)) return Vec3::Zero();
    const auto [segment, u] = locate(*this, t);
    const double v = 1 - u;
    return weighted(*this, segment, {-v * v / 2, u * (1.5 * u - 2), -v * (1.5 * v - 2), u * u / 2});
}

Vec3 Spline::bend(double t) const {
    if (is_point(*this)) return Vec3::Zero();
    const auto [segment, u] = locate(*this, t);
    return weighted(*this, segment, {1 - u, 3 * u - 2, 1 - 3 * u, u});
}

Spline interpolate(const std::vector<Vec3>& keys, bool is_periodic, const Vec3& shift) {
    Spline spline{keys, is_periodic, is_periodic ? shift : Vec3::Zero()};
    std::vector<Vec3>& q = spline.control;
    const std::size_t n = keys.size();
    if (is_periodic && n > 0) {
        // Straight progress along the shift is its own interpolation; what is left repeats.
        const Vec3 step = shift / static_cast<double>(n);
        for (std::size_t i = 0; i < n; ++i) q[i] -= static_cast<double>(i) * step;
        solve_ring(q);
        for (std::size_t i = 0; i < n; ++i) q[i] += static_cast<double>(i) * step;
    } else if (n > 2) {
        std::vector<Vec3> inner(keys.begin() + 1, keys.end() - 1);
        solve_open<Vec3>(inner, keys.front(), keys.back());
        std::copy(inner.begin(), inner.end(), q.begin() + 1);
    }
    return spline;
}

Spline resample(const Spline& spline, std::size_t points) {
    assert(points > (spline.is_periodic ? 0U : 1U) && !spline.control.empty());
    const double intervals = static_cast<double>(spline.is_periodic ? points : points - 1),
                 step = static_cast<double>(spline.segments()) / intervals;
    std::vector<Vec3> keys(points);
    for (std::size_t i = 0; i < points; ++i) keys[i] = spline.place(static_cast<double>(i) * step);
    return interpolate(keys, spline.is_periodic, spline.shift);
}

std::array<Vec3, 4> bezier(const Spline& spline, std::size_t index) {
    const auto i = static_cast<std::ptrdiff_t>(index);
    const Vec3 a = spline.at(i - 1), b = spline.at(i), c = spline.at(i + 1), d = spline.at(i + 2);
    return {(a + 4 * b + c) / 6, (2 * b + c) / 3, (b + 2 * c) / 3, (b + 4 * c + d) / 6};
}

}  // namespace weave
