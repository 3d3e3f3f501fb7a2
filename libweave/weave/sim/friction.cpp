#include <weave/sim/friction.hpp>

#include <algorithm>

namespace weave::sim {

namespace {

/// Places of the contact samples of a state.
template <class Real>
std::vector<Real> sample_places(const Fabric<Real>& fabric, const std::vector<Real>& state) {
    std::vector<Real> places;
    places.reserve(3 * fabric.samples());
    for (const SegmentPlace& segment : fabric.segment_places()) {
        const YarnConstants<Real>& yarn = fabric.constants()[segment.yarn];
        for (std::uint32_t k = 0; k < yarn.samples; ++k) {
            const Vec<Real> at =
                combine(fabric.bases()[yarn.basis + k].value, &state[3 * std::size_t(segment.slot)]);
            places.insert(places.end(), {at.x(), at.y(), at.z()});
        }
    }
    return places;
}

/// The state that slip counts from: that of the scene's control points, or an earlier one with other periods.
template <class Real>
std::vector<Real> start_of(const Fabric<Real>& fabric) {
    const SimScene& scene = fabric.scene();
    if (!scene.slip_from) return fabric.state();
    SimScene start = scene;
    for (std::size_t y = 0; y < start.yarns.size(); ++y) {
        start.yarns[y].control = scene.slip_from->control[y];
        for (std::size_t k = 0; k < 2; ++k) {
            if (scene.is_periodic[k])
                start.yarns[y].shift[Eigen::Index(k)] =
                    start.yarns[y].turns[k] * scene.slip_from->period_mm[k];
        }
    }
    return Fabric<Real>(start).state();
}

}  // namespace

template <class Real>
Friction<Real>::Friction(const Fabric<Real>& fabric) : m_fabric(fabric) {
    const SimScene& scene = fabric.scene();
    if (!(scene.friction > 0)) return;
    m_starts = sample_places(fabric, start_of(fabric));
    m_start_period = scene.slip_from ? scene.slip_from->period_mm : scene.period_mm;
}

template <class Real>
void Friction<Real>::clear() {
    m_pairs.clear();
    ++m_renewals;
}

template <class Real>
void Friction<Real>::renew(const FabricView<Real>& fabric, const Neighbours<Real>& neighbours,
                           const Executor& executor, double stick) {
    clear();
    if (m_starts.empty()) return;
    const std::size_t samples = m_fabric.samples();
    std::vector<Real> tangents(3 * samples);
    executor.each(m_fabric.segments(), PlaceTangents<Real>{fabric, tangents.data()});
    HoldPairs<Real> hold{
        fabric, neighbours.halo_samples(), samples, tangents.data(), m_starts.data(), {}, 0, 0, nullptr,
        nullptr};
    for (std::size_t k = 0; k < 2; ++k)
        hold.grown[k] = static_cast<Real>(m_fabric.scene().period_mm[k] - m_start_period[k]);
    hold.coefficient = static_cast<Real>(m_fabric.scene().friction);
    hold.stick = static_cast<Real>(stick);
    std::vector<std::uint32_t> count(samples);
    hold.first = count.data();
    executor.each(samples, hold);
    m_first.assign(samples + 1, 0);
    for (std::size_t a = 0; a < samples; ++a) m_first[a + 1] = m_first[a] + count[a];
    m_pairs.resize(m_first.back());
    if (m_pairs.empty()) return;
    hold.first = m_first.data();
    hold.pairs = m_pairs.data();
    executor.each(samples, hold);
}

template <class Real>
std::array<double, 2> Friction<Real>::image_pull(const FabricView<Real>& fabric) const {
    std::array<double, 2> pull{};
    if (!is_on()) return pull;
    for (std::size_t a = 0; a < m_fabric.samples(); ++a) {
        for (std::uint32_t p = m_first[a]; p < m_first[a + 1]; ++p) {
            const FrictionPair<Real>& pair = m_pairs[p];
            const PairSlip<Real> slip(pair,
                                      place_of(fabric.samples, a) - place_of(fabric.samples, pair.other));
            for (std::size_t k = 0; k < 2; ++k)
                pull[k] -=
                    pair.image[k] *
                    static_cast<double>(pair.limit_N * slip.law.stiffness * slip.slip[Eigen::Index(k)]) / 2;
        }
    }
    return pull;
}

template <class Real>
SlipSummary Friction<Real>::summary(const FabricView<Real>& fabric) const {
    SlipSummary summary;
    if (!is_on()) return summary;
    double stuck = 0;
    for (std::size_t a = 0; a < m_fabric.samples(); ++a) {
        for (std::uint32_t p = m_first[a]; p < m_first[a + 1]; ++p) {
            const FrictionPair<Real>& pair = m_pairs[p];
            const PairSlip<Real> slip(pair,
                                      place_of(fabric.samples, a) - place_of(fabric.samples, pair.other));
            const double press = static_cast<double>(pair.limit_N) / m_fabric.scene().friction / 2;
            summary.press_N += press;
            if (slip.far < pair.epsilon_mm) stuck += press;
            summary.farthest_mm = std::max(summary.farthest_mm, static_cast<double>(slip.far));
        }
    }
    summary.stuck_share = summary.press_N > 0 ? stuck / summary.press_N : 0;
    return summary;
}

template class Friction<float>;
template class Friction<double>;

}  // namespace weave::sim
