#include <weave/sim/centreline.hpp>

#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <limits>

namespace weave::sim {

namespace {

constexpr std::size_t looks_a_segment = 4, places_a_box = 16, boxes_a_group = 32;
constexpr int newton_rounds = 12;

}  // namespace

Alignment kabsch(const std::vector<Vec3>& from, const std::vector<Vec3>& to, bool mirrored) {
    Alignment alignment;
    alignment.mirrored = mirrored;
    const auto own = [&](const Vec3& place) {
        return mirrored ? Vec3(place.y(), place.x(), place.z()) : place;
    };
    Vec3 middle_from(0, 0, 0), middle_to(0, 0, 0);
    for (std::size_t i = 0; i < from.size(); ++i) {
        middle_from += own(from[i]);
        middle_to += to[i];
    }
    middle_from /= static_cast<double>(from.size());
    middle_to /= static_cast<double>(from.size());
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < from.size(); ++i)
        covariance += (to[i] - middle_to) * (own(from[i]) - middle_from).transpose();
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vec3 signs(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
    alignment.rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
    alignment.translation = middle_to - alignment.rotation * middle_from;
    return alignment;
}

CurveFinder::CurveFinder(Spline spline) : m_spline(std::move(spline)) {
    const std::size_t looks = std::max<std::size_t>(looks_a_segment * m_spline.segments(), 1);
    for (std::size_t k = 0; k <= looks; ++k)
        m_places.push_back(m_spline.place(static_cast<double>(k) / static_cast<double>(looks_a_segment)));
    // A spline's speed is a mean of its control differences, so no place lies further than this from the nearest look.
    const std::size_t points = m_spline.control.size();
    for (std::size_t i = 0; i + 1 < points; ++i)
        m_reach = std::max(m_reach, (m_spline.control[i + 1] - m_spline.control[i]).norm());
    if (m_spline.is_periodic && points > 0)
        m_reach = std::max(m_reach, (m_spline.control.front() + m_spline.shift - m_spline.control.back()).norm());
    m_reach /= 2.0 * looks_a_segment;
    for (const Vec3& place : m_places) m_middle += place / static_cast<double>(m_places.size());
    for (std::size_t first = 0; first < m_places.size(); first += places_a_box) {
        Box box{{}, first, std::min(first + places_a_box, m_places.size() - 1)};
        for (std::size_t k = box.first; k <= box.last; ++k) box.bounds.extend(m_places[k]);
        m_boxes.push_back(box);
    }
    for (std::size_t first = 0; first < m_boxes.size(); first += boxes_a_group) {
        Box group{{}, first, std::min(first + boxes_a_group, m_boxes.size()) - 1};
        for (std::size_t k = group.first; k <= group.last; ++k) group.bounds.extend(m_boxes[k].bounds);
        m_groups.push_back(group);
    }
}

/// Lowers `best`, a squared distance, and moves `at` there. `from`: the parameter of the first place.
void CurveFinder::search(const Vec3& place, double from, double& best, double& at) const {
    for (const Box& group : m_groups) {
        if (group.bounds.squaredExteriorDistance(place) >= best) continue;
        for (std::size_t b = group.first; b <= group.last; ++b) {
            const Box& box = m_boxes[b];
            if (box.bounds.squaredExteriorDistance(place) >= best) continue;
            for (std::size_t k = box.first; k <= box.last; ++k) {
                const double distance = (m_places[k] - place).squaredNorm();
                if (distance >= best) continue;
                best = distance;
                at = from + static_cast<double>(k) / static_cast<double>(looks_a_segment);
            }
        }
    }
}

/// The nearest look need not lead to the nearest place: each of the others may hide one nearer than `found`.
void CurveFinder::search_again(const Vec3& place, const Vec3& by, double from, OnCurve& found) const {
    const Vec3 own = place - by;
    const auto far = [&](const Box& box) {
        const double limit = found.distance + m_reach;
        return box.bounds.squaredExteriorDistance(own) >= limit * limit;
    };
    for (const Box& group : m_groups) {
        if (far(group)) continue;
        for (std::size_t b = group.first; b <= group.last; ++b) {
            if (far(m_boxes[b])) continue;
            for (std::size_t k = m_boxes[b].first; k <= m_boxes[b].last; ++k) {
                if ((m_places[k] - own).norm() >= found.distance + m_reach) continue;
                const double t = from + static_cast<double>(k) / static_cast<double>(looks_a_segment);
                const OnCurve other = refined(place, m_spline.is_periodic ? t : std::min(t, static_cast<double>(m_spline.segments())));
                if (other.distance < found.distance) found = other;
            }
        }
    }
}

OnCurve CurveFinder::refined(const Vec3& place, double t) const {
    const double low = m_spline.is_periodic ? std::numeric_limits<double>::lowest() : 0,
                 high = m_spline.is_periodic ? std::numeric_limits<double>::max()
                                             : static_cast<double>(m_spline.segments());
    double best = (m_spline.place(t) - place).squaredNorm();
    for (int round = 0; round < newton_rounds; ++round) {
        const Vec3 apart = m_spline.place(t) - place, way = m_spline.tangent(t);
        const double slope = apart.dot(way),
                     curvature = way.squaredNorm() + std::max(0.0, apart.dot(m_spline.bend(t)));
        if (!(curvature > 0)) break;
        const double next = std::clamp(t - std::clamp(slope / curvature, -0.5, 0.5), low, high);
        const double now = (m_spline.place(next) - place).squaredNorm();
        if (!(now < best)) break;
        best = now;
        t = next;
    }
    const Vec3 way = m_spline.tangent(t);
    const double speed = way.norm();
    return {m_spline.place(t), speed > 0 ? Vec3(way / speed) : Vec3(0, 0, 0), std::sqrt(best)};
}

OnCurve CurveFinder::nearest(const Vec3& place) const {
    // A periodic curve is looked at in the repeat where the place is, and in the two beside it.
    long middle = 0, beside = 0;
    const double repeat = m_spline.shift.squaredNorm();
    if (m_spline.is_periodic && repeat > 0) {
        middle = std::lround(std::clamp((place - m_middle).dot(m_spline.shift) / repeat, -1e9, 1e9));
        beside = 1;
    }
    double best = std::numeric_limits<double>::max(), at = 0;
    for (long turn = middle - beside; turn <= middle + beside; ++turn) {
        const auto turns = static_cast<double>(turn);
        search(place - turns * m_spline.shift, turns * static_cast<double>(m_spline.segments()), best, at);
    }
    if (!m_spline.is_periodic) at = std::min(at, static_cast<double>(m_spline.segments()));
    OnCurve found = refined(place, at);
    for (long turn = middle - beside; turn <= middle + beside; ++turn) {
        const auto turns = static_cast<double>(turn);
        search_again(place, turns * m_spline.shift, turns * static_cast<double>(m_spline.segments()), found);
    }
    return found;
}

std::vector<Vec3> CurveFinder::even_places(std::size_t count) const {
    return sim::even_places(m_places, count);
}

std::vector<Vec3> even_places(const std::vector<Vec3>& polyline, std::size_t count) {
    std::vector<double> along{0};
    for (std::size_t k = 1; k < polyline.size(); ++k)
        along.push_back(along.back() + (polyline[k] - polyline[k - 1]).norm());
    std::vector<Vec3> places;
    std::size_t piece = 1;
    for (std::size_t i = 0; i < count; ++i) {
        const double wish =
            count > 1 ? along.back() * static_cast<double>(i) / static_cast<double>(count - 1) : 0;
        while (piece + 1 < along.size() && along[piece] < wish) ++piece;
        if (along.size() < 2) {
            places.push_back(polyline.front());
            continue;
        }
        const double length = along[piece] - along[piece - 1];
        const double share = length > 0 ? std::clamp((wish - along[piece - 1]) / length, 0.0, 1.0) : 0;
        places.push_back((1 - share) * polyline[piece - 1] + share * polyline[piece]);
    }
    return places;
}

}  // namespace weave::sim
