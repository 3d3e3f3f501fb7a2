#include <weave/sim/planned_points.hpp>

#include <weave/curve/spline.hpp>
#include <weave/curve/wrapped.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace weave::sim {

namespace {

constexpr std::size_t rim_points = 2;  ///< control points held at a frozen end
constexpr std::size_t most_made = 4;

/// A key point or control point beyond a periodic yarn's ends: which one it is, and how many times round.
std::pair<std::size_t, double> wrapped_point(std::ptrdiff_t at, std::size_t count) {
    const Wrapped there = wrapped(at, static_cast<std::ptrdiff_t>(count));
    return {static_cast<std::size_t>(there.index), static_cast<double>(there.round)};
}

}  // namespace

PlannedPoints::PlannedPoints(const Design& design, const ClothCurves& curves, std::vector<std::size_t> keys, KeysOf keys_of, Held held,
                             double points_per_key, std::size_t most_at_once)
    : m_design(design),
      m_curves(curves),
      m_keys(std::move(keys)),
      m_keys_of(std::move(keys_of)),
      m_held(std::move(held)),
      m_points_per_key(points_per_key),
      m_most_at_once(most_at_once) {}

std::size_t PlannedPoints::count(std::size_t curve) const {
    const bool is_periodic = m_curves.yarns[curve].is_periodic;
    const auto segments = static_cast<double>(is_periodic || m_keys[curve] == 0 ? m_keys[curve] : m_keys[curve] - 1);
    const auto wanted = static_cast<std::size_t>(std::max(1.0, std::round(segments * m_points_per_key)));
    return is_periodic ? wanted : wanted + 1;
}

std::vector<KeyPoint> PlannedPoints::key_points(std::size_t curve, std::size_t first, std::size_t last) const {
    std::vector<KeyPoint> keys;
    m_keys_of(curve, first, last, keys);
    return keys;
}

void PlannedPoints::each_key(std::size_t curve, const std::function<bool(const KeyPoint&)>& visit) const {
    for (std::size_t first = 0; first < m_keys[curve]; first += std::min(m_most_at_once, m_keys[curve] - first)) {
        for (const KeyPoint& key : key_points(curve, first, first + std::min(m_most_at_once, m_keys[curve] - first))) {
            if (!visit(key)) return;
        }
    }
}

/// Places of key points, those of a periodic yarn beyond its ends too.
std::vector<Vec3> PlannedPoints::places(std::size_t curve, std::ptrdiff_t first, std::ptrdiff_t last) const {
    std::vector<Vec3> found;
    for (std::ptrdiff_t at = first; at < last;) {
        const auto [index, round] = wrapped_point(at, m_keys[curve]);
        const std::size_t until = std::min(m_keys[curve], index + static_cast<std::size_t>(last - at));
        for (const KeyPoint& key : key_points(curve, index, until)) found.emplace_back(key.place + round * m_curves.yarns[curve].shift);
        at += static_cast<std::ptrdiff_t>(until - index);
    }
    return found;
}

std::vector<Vec3> PlannedPoints::control(std::size_t curve, std::ptrdiff_t first, std::ptrdiff_t last) const {
    if (is_short(curve)) return of_whole(curve, first, last);
    std::vector<Vec3> control;
    for (std::ptrdiff_t at = first; at < last;) {
        const auto [index, round] = wrapped_point(at, count(curve));
        const std::size_t number = index / m_most_at_once;
        const std::vector<Vec3>& from = made(curve, number);
        const Vec3 moved = round * m_curves.yarns[curve].shift;
        for (std::size_t i = index - number * m_most_at_once; i < from.size() && at < last; ++i, ++at) control.emplace_back(from[i] + moved);
    }
    return control;
}

const std::vector<Vec3>& PlannedPoints::made(std::size_t curve, std::size_t number) const {
    const auto found = std::ranges::find_if(m_made, [&](const Made& one) { return one.curve == curve && one.number == number; });
    if (found != m_made.end()) return found->control;
    if (m_made.size() == most_made) m_made.pop_front();
    const std::size_t first = number * m_most_at_once, last = std::min(first + m_most_at_once, count(curve));
    m_made.push_back({curve, number, make(curve, static_cast<std::ptrdiff_t>(first), static_cast<std::ptrdiff_t>(last))});
    return m_made.back().control;
}

std::vector<Vec3> PlannedPoints::make(std::size_t curve, std::ptrdiff_t first, std::ptrdiff_t last) const {
    const YarnCurve& yarn = m_curves.yarns[curve];
    const auto points = static_cast<std::ptrdiff_t>(count(curve)), keys = static_cast<std::ptrdiff_t>(m_keys[curve]);
    const auto clip = [&](std::ptrdiff_t& from, std::ptrdiff_t& to, std::ptrdiff_t most) {
        if (yarn.is_periodic) return;
        from = std::max<std::ptrdiff_t>(from, 0);
        to = std::min(to, most);
    };
    const double step = static_cast<double>(yarn.is_periodic ? keys : keys - 1) / static_cast<double>(yarn.is_periodic ? points : points - 1);
    std::ptrdiff_t point = first - beside, last_point = last + beside;
    clip(point, last_point, points);
    std::ptrdiff_t key = static_cast<std::ptrdiff_t>(std::floor(static_cast<double>(point) * step)) - beside,
                   last_key = static_cast<std::ptrdiff_t>(std::ceil(static_cast<double>(last_point - 1) * step)) + beside + 1;
    clip(key, last_key, keys);
    const Spline spline = interpolate(places(curve, key, last_key), false, Vec3::Zero());
    std::vector<Vec3> through;
    for (std::ptrdiff_t i = point; i < last_point; ++i) through.push_back(spline.place(static_cast<double>(i) * step - static_cast<double>(key)));
    const std::vector<Vec3> made = interpolate(through, false, Vec3::Zero()).control;
    return {made.begin() + (first - point), made.begin() + (last - point)};
}

std::vector<Vec3> PlannedPoints::of_whole(std::size_t curve, std::ptrdiff_t first, std::ptrdiff_t last) const {
    const YarnCurve& yarn = m_curves.yarns[curve];
    const Spline spline = interpolate(places(curve, 0, static_cast<std::ptrdiff_t>(m_keys[curve])), yarn.is_periodic, yarn.shift);
    Spline made = resample(spline, count(curve));
    if (first == 0 && last == static_cast<std::ptrdiff_t>(made.control.size())) return std::move(made.control);
    std::vector<Vec3> control;
    for (std::ptrdiff_t i = first; i < last; ++i) control.push_back(made.at(i));
    return control;
}

std::vector<std::uint8_t> PlannedPoints::frozen(std::size_t curve, std::ptrdiff_t first, std::ptrdiff_t last) const {
    const YarnCurve& yarn = m_curves.yarns[curve];
    const std::size_t points = count(curve);
    if (first < 0 || last > static_cast<std::ptrdiff_t>(points)) {
        std::vector<std::uint8_t> all;
        for (std::ptrdiff_t at = first; at < last;) {
            const std::size_t from = wrapped_point(at, points).first, to = std::min(points, from + static_cast<std::size_t>(last - at));
            const std::vector<std::uint8_t> some = frozen(curve, static_cast<std::ptrdiff_t>(from), static_cast<std::ptrdiff_t>(to));
            all.insert(all.end(), some.begin(), some.end());
            at += static_cast<std::ptrdiff_t>(to - from);
        }
        return all;
    }
    std::vector<std::uint8_t> frozen(static_cast<std::size_t>(last - first), 0);
    const auto from = static_cast<std::size_t>(first);
    const bool pinned = std::ranges::any_of(m_design.scene.pins, [&](const Pin& pin) {
        return pin.is_pick == (yarn.system == System::weft) && pin.number == yarn.number;
    });
    if (pinned) return std::vector<std::uint8_t>(frozen.size(), 1);
    freeze_rim(curve, from, frozen);
    const std::size_t axis = yarn.system == System::warp ? 0 : 1;
    const bool ends = !yarn.is_periodic && m_held.rim[axis] == Boundary::frozen;
    for (std::size_t i = 0; ends && i < frozen.size(); ++i) {
        if (from + i < rim_points || from + i + rim_points >= points) frozen[i] = 1;
    }
    for (const std::size_t key : m_held.crossings[curve]) hold(curve, key, from, frozen);
    return frozen;
}

/// A frozen rim holds the yarns along it too: they would slide off the cut ends of those that they cross.
void PlannedPoints::freeze_rim(std::size_t curve, std::size_t first, std::vector<std::uint8_t>& frozen) const {
    const Region& region = m_curves.region;
    const bool rows = m_held.rim[0] == Boundary::frozen && !m_curves.is_periodic[0],
               columns = m_held.rim[1] == Boundary::frozen && !m_curves.is_periodic[1];
    if (!rows && !columns) return;
    const bool is_open = !m_curves.yarns[curve].is_periodic;
    const std::size_t keys = m_keys[curve], pieces = keys - (is_open ? 1 : 0);
    const double per_key = double(count(curve) - (is_open ? 1 : 0)) / double(std::max<std::size_t>(1, pieces));
    const auto key_of = [&](std::size_t i) { return std::min(static_cast<std::size_t>(std::lround(static_cast<double>(first + i) / per_key)), keys - 1); };
    const std::size_t first_key = key_of(0);
    const std::vector<KeyPoint> near = key_points(curve, first_key, key_of(frozen.size() - 1) + 1);
    for (std::size_t i = 0; i < frozen.size(); ++i) {
        const KeyPoint& key = near[key_of(i) - first_key];
        if ((rows && (key.row == region.first_row || key.row == region.last_row)) ||
            (columns && (key.column == region.first_column || key.column == region.last_column)))
            frozen[i] = 1;
    }
}

/// Holds the place of a key point: three control points make it.
void PlannedPoints::hold(std::size_t curve, std::size_t key, std::size_t first, std::vector<std::uint8_t>& frozen) const {
    const bool is_periodic = m_curves.yarns[curve].is_periodic;
    const std::size_t points = count(curve), keys = m_keys[curve];
    const double per_key = is_periodic ? double(points) / double(keys) : double(points - 1) / double(keys - 1);
    const auto at = static_cast<std::ptrdiff_t>(std::lround(per_key * static_cast<double>(key)));
    for (std::ptrdiff_t i = at - 1; i <= at + 1; ++i) {
        if (!is_periodic && (i < 0 || i >= static_cast<std::ptrdiff_t>(points))) continue;
        const std::size_t index = wrapped_point(i, points).first;
        if (index >= first && index < first + frozen.size()) frozen[index - first] = 1;
    }
}

}  // namespace weave::sim
