#include <weave/sim/fabric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace weave::sim {

namespace {

template <class Real>
Gauss<Real> gauss_rule() {
    const double near = std::sqrt(3.0 / 7 - 2.0 / 7 * std::sqrt(6.0 / 5)),
                 far = std::sqrt(3.0 / 7 + 2.0 / 7 * std::sqrt(6.0 / 5));
    const double heavy = (18 + std::sqrt(30.0)) / 36, light = (18 - std::sqrt(30.0)) / 36;
    const double places[]{-far, -near, near, far}, weights[]{light, heavy, heavy, light};
    Gauss<Real> gauss;
    for (std::size_t g = 0; g < gauss_points; ++g) {
        gauss.basis[g] = basis_at(static_cast<Real>((1 + places[g]) / 2));
        gauss.weight[g] = static_cast<Real>(weights[g] / 2);
    }
    return gauss;
}

}  // namespace

double control_length(const SimYarn& yarn) {
    double length = 0;
    for (std::size_t i = 0; i + 1 < yarn.control.size(); ++i)
        length += (yarn.control[i + 1] - yarn.control[i]).norm();
    if (yarn.is_periodic && !yarn.control.empty())
        length += (yarn.control.front() + yarn.shift - yarn.control.back()).norm();
    return length;
}

template <class Real>
Fabric<Real>::Fabric(const SimScene& scene) : m_scene(scene), m_gauss(gauss_rule<Real>()) {
    double least_radius = scene.least_radius_mm > 0 ? scene.least_radius_mm : std::numeric_limits<double>::infinity();
    for (const SimYarn& yarn : scene.yarns) {
        least_radius = std::min(least_radius, yarn.radius_mm);
        m_greatest_radius = std::max(m_greatest_radius, yarn.radius_mm);
    }
    m_least_reach = scene.yarns.empty() ? 0 : 2 * least_radius;
    for (const SimYarn& yarn : scene.yarns) add_yarn(yarn);
}

template <class Real>
void Fabric<Real>::add_yarn(const SimYarn& yarn) {
    const auto points = static_cast<std::uint32_t>(yarn.control.size());
    YarnPlace place;
    place.points = points;
    // A yarn of one point is no curve: it stays where it is, and nothing meets it.
    const std::uint32_t beyond = (yarn.is_cut[0] ? 1U : 0U) + (yarn.is_cut[1] ? 1U : 0U);
    place.segments = yarn.is_periodic ? points : std::max(points, 1 + beyond) - 1 - beyond;
    place.slots = points + (yarn.is_periodic ? 3 : 2);
    place.skipped = yarn.is_cut[0] ? 1 : 0;
    place.first_slot = static_cast<std::uint32_t>(m_moves.size());
    place.first_segment = static_cast<std::uint32_t>(m_segments.size());
    const auto index = static_cast<std::uint32_t>(m_places.size());

    // A few more samples than the planned length asks for keep the spacing when the yarn grows.
    const double whole = std::max<double>(1, yarn.whole_segments > 0 ? static_cast<double>(yarn.whole_segments) : place.segments);
    const double length = (yarn.planned_mm > 0 ? yarn.planned_mm : control_length(yarn)) / whole;
    const double nearest = yarn.radius_mm + m_least_reach / 2;
    const double wanted = std::ceil(1.05 * length / (scene().sample_spacing * nearest));
    const auto samples = static_cast<std::uint32_t>(std::clamp(wanted, 2.0, 4096.0));

    YarnConstants<Real> constants{};
    constants.radius_mm = static_cast<Real>(yarn.radius_mm);
    constants.stretch_N = static_cast<Real>(yarn.stretch_N);
    constants.bending = static_cast<Real>(yarn.bending_N_mm2);
    constants.tension_N = static_cast<Real>(yarn.stretch_N * (yarn.strain - 1));
    constants.evenness_N = static_cast<Real>(yarn.stretch_N * yarn.strain);
    constants.rest_mm = static_cast<Real>(yarn.rest_mm / whole);
    constants.root_k = static_cast<Real>(std::sqrt(yarn.contact_N_mm2));
    constants.supply = yarn.is_fed ? Supply::tension : Supply::length;
    constants.samples = samples;
    constants.basis = basis_for(samples);
    m_constants.push_back(constants);

    for (std::uint32_t s = 0; s < place.segments; ++s) {
        m_segments.push_back({place.first_slot + place.skipped + s, index, static_cast<std::uint32_t>(m_samples)});
        m_samples += samples;
    }
    m_moves.resize(m_moves.size() + place.slots, 0);
    m_yarn_of_slot.resize(m_moves.size(), index);
    for (std::uint32_t i = 0; i < points; ++i)
        m_moves[place.first_slot + 1 + i] = place.segments > 0 && (yarn.frozen.empty() || yarn.frozen[i] == 0);
    add_guests(yarn, place);
    m_points += points;
    if (place.segments > 0) add_follows(yarn, place);
    m_places.push_back(place);
}

template <class Real>
void Fabric<Real>::add_guests(const SimYarn& yarn, const YarnPlace& place) {
    if (yarn.guests.empty() && m_guests.empty()) return;
    m_guests.resize(m_moves.size(), 0);
    if (yarn.guests.empty()) return;
    std::copy(yarn.guests.begin(), yarn.guests.end(), m_guests.begin() + place.first_slot + 1);
    m_guests[place.first_slot] = yarn.guests.front();
    for (std::size_t slot = place.first_slot + 1 + place.points; slot < place.first_slot + place.slots; ++slot)
        m_guests[slot] = yarn.guests.back();
}

template <class Real>
void Fabric<Real>::add_follows(const SimYarn& yarn, const YarnPlace& place) {
    const std::uint32_t zero = place.first_slot + 1, points = place.points;
    if (!yarn.is_periodic) {
        const std::uint32_t last = zero + points - 1;
        if (!yarn.is_cut[0]) m_follows.push_back({zero - 1, {zero, zero + 1}, {2, -1}, 0});
        if (!yarn.is_cut[1]) m_follows.push_back({last + 1, {last, last - 1}, {2, -1}, 0});
        return;
    }
    for (const std::int64_t i : {std::int64_t{-1}, std::int64_t{points}, std::int64_t{points} + 1}) {
        const std::int64_t count = points, turns = (i + count) / count - 1;
        const auto of = static_cast<std::uint32_t>(i - turns * count);
        m_follows.push_back({static_cast<std::uint32_t>(std::int64_t{zero} + i),
                             {zero + of, zero + of},
                             {1, 0},
                             static_cast<int>(turns)});
    }
}

template <class Real>
std::uint32_t Fabric<Real>::basis_for(std::uint32_t samples) {
    for (const auto& [count, basis] : m_basis_of_samples) {
        if (count == samples) return basis;
    }
    const auto basis = static_cast<std::uint32_t>(m_bases.size());
    for (std::uint32_t k = 0; k < samples; ++k)
        m_bases.push_back(basis_at((static_cast<Real>(k) + Real(0.5)) / static_cast<Real>(samples)));
    m_basis_of_samples.emplace_back(samples, basis);
    return basis;
}

template <class Real>
std::vector<Real> Fabric<Real>::state() const {
    std::vector<Real> state(3 * slots());
    for (std::size_t y = 0; y < m_places.size(); ++y) {
        for (std::size_t i = 0; i < m_places[y].points; ++i) {
            for (std::size_t k = 0; k < 3; ++k)
                state[3 * (m_places[y].first_slot + 1 + i) + k] =
                    static_cast<Real>(m_scene.yarns[y].control[i][static_cast<Eigen::Index>(k)]);
        }
    }
    follow(state);
    return state;
}

template <class Real>
std::vector<std::vector<Vec3>> Fabric<Real>::control(const std::vector<Real>& state) const {
    std::vector<std::vector<Vec3>> control;
    for (const YarnPlace& place : m_places) {
        std::vector<Vec3> points;
        for (std::size_t i = 0; i < place.points; ++i)
            points.push_back(load(&state[3 * (place.first_slot + 1 + i)]).template cast<double>());
        control.push_back(std::move(points));
    }
    return control;
}

template <class Real>
double Fabric<Real>::length_mm(const std::vector<Real>& state, std::size_t yarn) const {
    const YarnPlace& place = m_places[yarn];
    double length = 0;
    for (std::size_t s = 0; s < place.segments; ++s)
        length += static_cast<double>(Speeds<Real>(m_gauss, &state[3 * std::size_t(m_segments[place.first_segment + s].slot)]).length);
    return length;
}

template <class Real>
void Fabric<Real>::follow(std::vector<Real>& state) const {
    follow_change(state);
    for (const FollowSlot& follow : m_follows) {
        if (follow.turns == 0) continue;
        const Vec3& shift = m_scene.yarns[m_yarn_of_slot[follow.slot]].shift;
        for (std::size_t k = 0; k < 3; ++k)
            state[3 * follow.slot + k] += static_cast<Real>(follow.turns * shift[static_cast<Eigen::Index>(k)]);
    }
}

template <class Real>
void Fabric<Real>::follow_change(std::vector<Real>& change) const {
    for (const FollowSlot& follow : m_follows) {
        for (std::size_t k = 0; k < 3; ++k)
            change[3 * follow.slot + k] =
                static_cast<Real>(follow.weight[0]) * change[3 * follow.from[0] + k] +
                static_cast<Real>(follow.weight[1]) * change[3 * follow.from[1] + k];
    }
}

template <class Real>
void Fabric<Real>::fold(std::vector<Real>& gradient) const {
    for (const FollowSlot& follow : m_follows) {
        for (std::size_t k = 0; k < 3; ++k) {
            Real& gathered = gradient[3 * follow.slot + k];
            gradient[3 * follow.from[0] + k] += static_cast<Real>(follow.weight[0]) * gathered;
            gradient[3 * follow.from[1] + k] += static_cast<Real>(follow.weight[1]) * gathered;
            gathered = 0;
        }
    }
    for (std::size_t slot = 0; slot < m_moves.size(); ++slot) {
        if (m_moves[slot] != 0 && !is_guest(slot)) continue;
        for (std::size_t k = 0; k < 3; ++k) gradient[3 * slot + k] = 0;
    }
}

template class Fabric<float>;
template class Fabric<double>;

}  // namespace weave::sim
