#include <weave/sim/energy.hpp>

#include <algorithm>
#include <cmath>

namespace weave::sim {

namespace {

/// Below a tenth of the reach the contact law goes on linearly.
constexpr double contact_floor = 0.01;

}  // namespace

template <class Real>
Energy<Real>::Energy(const Fabric<Real>& fabric, const Executor& executor)
    : m_fabric(fabric),
      m_executor(executor),
      m_transition(fabric),
      m_friction(fabric),
      m_neighbours(fabric, executor, m_transition),
      m_spheres(spheres_of<Real>(fabric.scene())),
      m_segment_energy(fabric.segments()),
      m_segment_gradient(12 * fabric.segments()) {}

template <class Real>
FabricView<Real> Energy<Real>::view(const std::vector<Real>& state) {
    return {state.data(),
            m_fabric.segment_places().data(),
            m_fabric.constants().data(),
            m_fabric.bases().data(),
            &m_fabric.gauss(),
            m_neighbours.samples(),
            m_neighbours.first(),
            m_neighbours.others(),
            static_cast<Real>(contact_floor),
            static_cast<Real>(m_give)};
}

template <class Real>
void Energy<Real>::lay_samples(const std::vector<Real>& state) {
    m_executor.each_wide(m_fabric.segments(), PlaceSamples<Real>{view(state)});
    m_neighbours.update();
}

template <class Real>
const std::vector<Real>& Energy<Real>::first_weights(const std::vector<Real>& state) {
    if (m_neighbours.first_weights().empty()) {
        m_executor.each_wide(m_fabric.segments(), PlaceSamples<Real>{view(state)});
        m_neighbours.keep_first_weights();
    }
    return m_neighbours.first_weights();
}

template <class Real>
void Energy<Real>::renew_friction(const std::vector<Real>& state, double stick) {
    lay_samples(state);
    m_friction.renew(view(state), m_neighbours, m_executor, stick);
}

template <class Real>
double Energy<Real>::evaluate(const std::vector<Real>& state, std::vector<Real>& gradient, Terms terms) {
    ++m_evaluations;
    lay_samples(state);
    m_executor.each_wide(m_fabric.segments(), SegmentForces<Real>{view(state), terms, m_segment_energy.data(),
                                                                  m_segment_gradient.data()});
    if (terms.elastic && !m_spheres.empty()) {
        m_executor.each(m_fabric.segments(),
                        FieldForces<Real>{view(state), m_spheres.data(), m_spheres.size(),
                                          m_segment_energy.data(), m_segment_gradient.data()});
    }
    if (terms.elastic && m_friction.is_on()) {
        m_executor.each(m_fabric.segments(), FrictionForces<Real>{view(state), m_friction.view(), m_segment_energy.data(),
                                                                  m_segment_gradient.data()});
    }
    gather(gradient);
    double energy = m_executor.sum(
        m_fabric.segments(), [&](std::size_t s) { return m_fabric.is_own(s) ? static_cast<double>(m_segment_energy[s]) : 0; });
    if (terms.elastic && m_fabric.scene().gravity_mm_ms2 != 0) energy += add_weight(state, gradient);
    if (terms.contact && m_transition.is_on()) energy += m_transition.add(view(state), gradient);
    m_fabric.fold(gradient);
    return energy;
}

template <class Real>
std::array<double, 2> Energy<Real>::period_gradient(const std::vector<Real>& state) {
    std::vector<Real> by_slot;
    evaluate(state, by_slot);
    gather(by_slot);  // what the segments pull at slots beyond the ends, which move with the period
    std::array<double, 2> gradient{};
    for (const FollowSlot& follow : m_fabric.follows()) {
        const SimYarn& yarn = m_fabric.scene().yarns[m_fabric.yarn_of_slot()[follow.slot]];
        for (std::size_t k = 0; k < 2; ++k)
            gradient[k] += follow.turns * yarn.turns[k] * static_cast<double>(by_slot[3 * follow.slot + k]);
    }
    const FabricView<Real> fabric = view(state);
    const std::array<double, 2> rubbing = m_friction.image_pull(fabric);
    for (std::size_t k = 0; k < 2; ++k) {
        gradient[k] += rubbing[k] + m_executor.sum(m_fabric.samples(), [&](std::size_t a) { return image_pull(fabric, a, k); });
    }
    return gradient;
}

/// What a sample pulls at the images of others when the period along axis `k` grows; each of a pair has half
/// of it.
template <class Real>
double Energy<Real>::image_pull(const FabricView<Real>& fabric, std::size_t a, std::size_t k) const {
    const SamplesView<Real>& all = fabric.samples;
    double sum = 0;
    for (std::uint32_t e = fabric.first_neighbour[a]; e < fabric.first_neighbour[a + 1]; ++e) {
        const std::uint32_t b = fabric.neighbours[e];
        const int images = m_neighbours.image(b)[k];
        if (images == 0) continue;
        const Vec<Real> apart(all.x[a] - all.x[b], all.y[a] - all.y[b], all.z[a] - all.z[b]);
        const Real reach = all.radius[a] + all.radius[b], limit = reach * reach;
        const ContactLaw<Real> law = ContactLaw<Real>::at(apart.squaredNorm() / limit, fabric.floor);
        sum -= images * static_cast<double>(all.weight[a] * all.weight[b] * law.slope / limit *
                                            apart[static_cast<Eigen::Index>(k)]);
    }
    return sum;
}

/// Each slot adds up what the segments that reach it have found: segment s - c of its yarn at its place c.
template <class Real>
void Energy<Real>::gather(std::vector<Real>& gradient) const {
    gradient.resize(3 * m_fabric.slots());
    const std::vector<YarnPlace>& yarns = m_fabric.yarns();
    const std::vector<std::uint32_t>& yarn_of_slot = m_fabric.yarn_of_slot();
    m_executor.each(m_fabric.slots(), [&](std::size_t slot) {
        const YarnPlace& yarn = yarns[yarn_of_slot[slot]];
        const std::size_t within = slot - yarn.first_slot - yarn.skipped;
        Real sum[3]{};
        for (std::size_t c = 0; c < 4; ++c) {
            if (within - c >= yarn.segments) continue;  // also where it would be below 0
            const Real* part = &m_segment_gradient[12 * (yarn.first_segment + within - c) + 3 * c];
            for (int k = 0; k < 3; ++k) sum[k] += part[k];
        }
        for (std::size_t k = 0; k < 3; ++k) gradient[3 * slot + k] = sum[k];
    });
}

/// Weight times mean height of each segment, which is ∫ of its four splines: else the tip of a yarn would
/// weigh double.
template <class Real>
double Energy<Real>::add_weight(const std::vector<Real>& state, std::vector<Real>& gradient) const {
    constexpr double shares[]{1.0 / 24, 11.0 / 24, 11.0 / 24, 1.0 / 24};
    const SimScene& scene = m_fabric.scene();
    double energy = 0;
    for (std::size_t s = 0; s < m_fabric.segments(); ++s) {
        const SegmentPlace& segment = m_fabric.segment_places()[s];
        const double weight = scene.yarns[segment.yarn].gram_per_mm * scene.gravity_mm_ms2 *
                              static_cast<double>(m_fabric.constants()[segment.yarn].rest_mm);
        for (std::size_t c = 0; c < 4; ++c) {
            const std::size_t z = 3 * (segment.slot + c) + 2;
            if (m_fabric.is_own(s)) energy += weight * shares[c] * static_cast<double>(state[z]);
            gradient[z] += static_cast<Real>(weight * shares[c]);
        }
    }
    return energy;
}

template <class Real>
void Energy<Real>::move_samples(const std::vector<Real>& state, const std::vector<Real>& change) {
    m_moved.resize(3 * m_fabric.samples());
    m_tangent.resize(3 * m_fabric.samples());
    const std::vector<SegmentPlace>& segments = m_fabric.segment_places();
    m_executor.each(segments.size(), [&](std::size_t s) {
        const YarnConstants<Real>& yarn = m_fabric.constants()[segments[s].yarn];
        for (std::uint32_t k = 0; k < yarn.samples; ++k) {
            const Basis<Real>& basis = m_fabric.bases()[yarn.basis + k];
            const std::size_t slot = 3 * std::size_t(segments[s].slot), sample = 3 * (segments[s].sample + k);
            const Vec<Real> moved = combine(basis.value, &change[slot]),
                            tangent = combine(basis.slope, &state[slot]);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                m_moved[sample + axis] = moved[static_cast<Eigen::Index>(axis)];
                m_tangent[sample + axis] = tangent[static_cast<Eigen::Index>(axis)];
            }
        }
    });
}

/// Of two own samples, in the state that move_samples() was told of.
template <class Real>
CrossingLines<Real> Energy<Real>::lines(std::size_t sample, std::size_t other, const Vec<Real>& apart, Real reach) const {
    return CrossingLines<Real>::of(load(&m_tangent[3 * sample]), load(&m_tangent[3 * other]), apart, reach, m_neighbours.are_of_one_yarn(sample, other));
}

/// The share by which sample `a` may go: no near one comes closer by 0.45 of its distance. Squares alone, so
/// that the loop over neighbours has neither roots nor divisions.
template <class Real>
double Energy<Real>::safe_share_of(const FabricView<Real>& fabric, std::size_t a, double most) const {
    const SamplesView<Real>& all = fabric.samples;
    const Vec<Real> mine = load(&m_moved[3 * a]), at(all.x[a], all.y[a], all.z[a]);
    const auto moved = static_cast<double>(mine.norm());
    double share = std::min(most, m_fabric.least_reach() / 4 / std::max(1e-300, moved));
    Real change2 = 0, apart2 = 1;  // of the pair that allows least
    for (std::uint32_t e = fabric.first_neighbour[a]; e < fabric.first_neighbour[a + 1]; ++e) {
        const std::uint32_t b = fabric.neighbours[e], own = m_neighbours.own(b);
        const Vec<Real> apart = at - Vec<Real>(all.x[b], all.y[b], all.z[b]),
                        change = mine - load(&m_moved[3 * std::size_t(own)]);
        const Real near2 = apart.squaredNorm(), closing2 = change.squaredNorm(),
                   reach = all.radius[a] + all.radius[b];
        if (near2 < reach * reach / 4)
            share = std::min(share, lines(a, own, apart, reach).share(change, reach));
        if (closing2 * apart2 <= change2 * near2) continue;
        change2 = closing2;
        apart2 = near2;
    }
    if (change2 > 0)
        share =
            std::min(share, closest * std::sqrt(static_cast<double>(apart2) / static_cast<double>(change2)));
    return share;
}

template <class Real>
double Energy<Real>::safe_share(const std::vector<Real>& state, const std::vector<Real>& change,
                                double most) {
    move_samples(state, change);
    const FabricView<Real> fabric = view(state);
    return m_executor.least(
        m_fabric.samples(), [&](std::size_t a) { return safe_share_of(fabric, a, most); }, most);
}

template <class Real>
bool Energy<Real>::find_safe_shares(const std::vector<Real>& state, const std::vector<Real>& change, std::vector<double>& share) {
    const FabricView<Real> fabric = view(state);
    share.resize(m_fabric.segments());
    move_samples(state, change);
    m_executor.each(share.size(), [&](std::size_t s) {
        const SegmentPlace& segment = fabric.segments[s];
        share[s] = 1;
        for (std::uint32_t k = 0; k < fabric.yarns[segment.yarn].samples; ++k)
            share[s] = std::min(share[s], safe_share_of(fabric, segment.sample + k, 1));
    });
    return std::all_of(share.begin(), share.end(), [](double part) { return part >= ShorteningRounds::enough; });
}

/// What of a slot's change does not bring samples nearer that are pressed together, of the segments that it reaches and that may not move.
template <class Real>
Vec<Real> Energy<Real>::without_closing(const FabricView<Real>& fabric, const std::vector<double>& share, std::size_t slot, Vec<Real> mine) const {
    const SamplesView<Real>& all = fabric.samples;
    const YarnPlace& yarn = m_fabric.yarns()[m_fabric.yarn_of_slot()[slot]];
    const std::size_t within = slot - yarn.first_slot - yarn.skipped;
    for (std::size_t c = 0; c < 4; ++c) {
        if (within - c >= yarn.segments || share[yarn.first_segment + within - c] > 0) continue;
        const SegmentPlace& segment = fabric.segments[yarn.first_segment + within - c];
        for (std::size_t a = segment.sample; a < segment.sample + fabric.yarns[segment.yarn].samples; ++a) {
            const Vec<Real> at(all.x[a], all.y[a], all.z[a]), moved = load(&m_moved[3 * a]);
            for (std::uint32_t e = fabric.first_neighbour[a]; e < fabric.first_neighbour[a + 1]; ++e) {
                const std::uint32_t b = fabric.neighbours[e];
                const std::size_t own = m_neighbours.own(b);
                const Vec<Real> apart = at - Vec<Real>(all.x[b], all.y[b], all.z[b]), theirs = load(&m_moved[3 * own]);
                const Real reach = all.radius[a] + all.radius[b];
                if (apart.squaredNorm() >= reach * reach / 4) continue;
                const CrossingLines<Real> both = lines(a, own, apart, reach);
                if (both.is_pressed(reach) && both.closing(moved - theirs) > 0) mine = both.without_closing(mine, moved, theirs);
            }
        }
    }
    return mine;
}

/// A slot beyond a yarn's end that moves as a control point does counts with that one.
template <class Real>
void Energy<Real>::leave_out_closing(const FabricView<Real>& fabric, const std::vector<double>& share, std::vector<Real>& change) const {
    const auto put = [&](std::size_t slot, const Vec<Real>& moves) {
        for (std::size_t k = 0; k < 3; ++k) change[3 * slot + k] = moves[static_cast<Eigen::Index>(k)];
    };
    m_executor.each(m_fabric.slots(), [&](std::size_t slot) {
        if (m_fabric.moves()[slot] != 0) put(slot, without_closing(fabric, share, slot, load(&change[3 * slot])));
    });
    for (const FollowSlot& follow : m_fabric.follows()) {
        const std::size_t from = follow.from[0];
        if (follow.weight[0] == 1 && m_fabric.moves()[from] != 0) put(from, without_closing(fabric, share, follow.slot, load(&change[3 * from])));
    }
}

template <class Real>
void Energy<Real>::shorten_by(const std::vector<Real>& state, std::vector<double>& share, int round, std::vector<Real>& change) {
    if (round >= ShorteningRounds::gentle) {
        // What is still not safe does not move at all: else one place would hold up the whole cloth.
        for (double& part : share) part = part < ShorteningRounds::enough ? 0 : 1;
    } else if (std::ranges::find(share, 0.0) != share.end()) {
        leave_out_closing(view(state), share, change);
        std::ranges::replace(share, 0.0, 1.0);
    }
    std::vector<double> least(m_fabric.slots());
    m_executor.each(m_fabric.slots(), [&](std::size_t slot) {
        const YarnPlace& yarn = m_fabric.yarns()[m_fabric.yarn_of_slot()[slot]];
        const std::size_t within = slot - yarn.first_slot - yarn.skipped;
        least[slot] = 1;
        for (std::size_t c = 0; c < 4; ++c) {
            if (within - c < yarn.segments) least[slot] = std::min(least[slot], share[yarn.first_segment + within - c]);
        }
    });
    for (const FollowSlot& follow : m_fabric.follows()) {
        for (std::size_t k = 0; k < 2; ++k) {
            if (follow.weight[k] != 0) least[follow.from[k]] = std::min(least[follow.from[k]], least[follow.slot]);
        }
    }
    m_executor.each(change.size(), [&](std::size_t i) { change[i] *= static_cast<Real>(least[i / 3]); });
    m_fabric.follow_change(change);
}

template <class Real>
void Energy<Real>::shorten(const std::vector<Real>& state, std::vector<Real>& change) {
    std::vector<double> share;
    for (int round = 0; round < ShorteningRounds::most; ++round) {
        if (find_safe_shares(state, change, share)) return;
        shorten_by(state, share, round, change);
    }
    // Rounds may run out before all places agree; then all of it is shortened alike.
    const auto whole = static_cast<Real>(safe_share(state, change, 1));
    if (whole < Real(ShorteningRounds::enough)) {
        for (Real& part : change) part *= whole;
    }
}

template class Energy<float>;
template class Energy<double>;

}  // namespace weave::sim
