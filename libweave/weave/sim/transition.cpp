#include <weave/sim/transition.hpp>

#include <algorithm>
#include <cmath>

namespace weave::sim {

namespace {

/// What a segment of a yarn is when counted on beyond its ends: the segment, and how often the yarn was gone round.
struct Counted {
    std::uint32_t segment = 0;
    double turns = 0;
};

Counted counted(std::int64_t number, const YarnPlace& place, bool is_periodic) {
    const auto segments = static_cast<std::int64_t>(place.segments);
    if (!is_periodic)
        return {place.first_segment + static_cast<std::uint32_t>(std::clamp<std::int64_t>(number, 0, segments - 1)), 0};
    const std::int64_t turns = number >= 0 ? number / segments : -((segments - 1 - number) / segments);
    return {place.first_segment + static_cast<std::uint32_t>(number - turns * segments), static_cast<double>(turns)};
}

}  // namespace

template <class Real>
Transition<Real>::Transition(const Fabric<Real>& fabric) {
    if (!fabric.scene().transition) return;
    m_on = true;
    m_pair = *fabric.scene().transition;
    m_side.assign(fabric.samples(), 0);
    for (std::size_t side = 0; side < 2; ++side) list_stretch(fabric, side);
}

template <class Real>
void Transition<Real>::list_stretch(const Fabric<Real>& fabric, std::size_t side) {
    const std::size_t yarn = m_pair.yarn[side];
    const SimYarn& of = fabric.scene().yarns[yarn];
    const YarnPlace& place = fabric.yarns()[yarn];
    const std::uint32_t samples = fabric.constants()[yarn].samples;
    const double at = m_pair.at[side], reach = m_pair.reach[side];
    const double whole = std::floor(at);
    const Counted here = counted(static_cast<std::int64_t>(whole), place, of.is_periodic);
    m_crossing[side] = {here.segment, 0, here.turns * of.shift};
    const double share = of.is_periodic ? at - whole : at - double(here.segment - place.first_segment);
    m_basis[side] = basis_at(share);
    for (auto number = static_cast<std::int64_t>(std::floor(at - reach)); number <= static_cast<std::int64_t>(at + reach); ++number) {
        if (!of.is_periodic && (number < 0 || number >= static_cast<std::int64_t>(place.segments))) continue;
        const Counted segment = counted(number, place, of.is_periodic);
        for (std::uint32_t k = 0; k < samples; ++k) {
            const double parameter = static_cast<double>(number) + (k + 0.5) / samples;
            if (std::abs(parameter - at) > reach) continue;
            m_stretch[side].push_back({segment.segment, k, segment.turns * of.shift});
            m_side[fabric.segment_places()[segment.segment].sample + k] = static_cast<std::uint8_t>(side + 1);
        }
    }
}

/// A sample of a stretch as it lies now.
template <class Real>
struct Transition<Real>::Laid {
    Vec<double> place, tangent;
    double weight = 0, speed = 0, share = 0;  ///< weight = share · speed
    const Basis<Real>* basis = nullptr;
    std::uint32_t slot = 0, segment = 0;
};

template <class Real>
std::vector<typename Transition<Real>::Laid> Transition<Real>::lay(const FabricView<Real>& fabric, std::size_t side) const {
    std::vector<Laid> laid;
    for (const Sample& sample : m_stretch[side]) {
        const SegmentPlace& segment = fabric.segments[sample.segment];
        const YarnConstants<Real>& yarn = fabric.yarns[segment.yarn];
        const Real* slots = fabric.place + 3 * std::size_t(segment.slot);
        Laid one;
        one.basis = &fabric.bases[yarn.basis + sample.within];
        one.place = combine(one.basis->value, slots).template cast<double>() + sample.offset;
        one.tangent = combine(one.basis->slope, slots).template cast<double>();
        one.speed = std::max(one.tangent.norm(), 1e-3 * double(yarn.radius_mm));
        one.share = double(yarn.root_k) / yarn.samples;
        one.weight = one.share * one.speed;
        one.slot = segment.slot;
        one.segment = sample.segment;
        laid.push_back(one);
    }
    return laid;
}

namespace {

template <class Real, class Weights>
void add_to(std::vector<Real>& gradient, std::uint32_t slot, const Weights& weights, const Vec<double>& force) {
    for (std::size_t c = 0; c < 4; ++c) {
        for (std::size_t k = 0; k < 3; ++k)
            gradient[3 * (slot + c) + k] += static_cast<Real>(double(weights[c]) * force[static_cast<Eigen::Index>(k)]);
    }
}

}  // namespace

/// Height of the first yarn above the second at the crossing, less what it is to be.
template <class Real>
double Transition<Real>::lift(const FabricView<Real>& fabric) const {
    double height[2];
    for (std::size_t side = 0; side < 2; ++side) {
        const Real* slots = fabric.place + 3 * std::size_t(fabric.segments[m_crossing[side].segment].slot);
        height[side] = m_crossing[side].offset.z();
        for (int c = 0; c < 4; ++c) height[side] += m_basis[side].value[c] * double(slots[3 * c + 2]);
    }
    return height[0] - height[1] - m_pair.height_mm;
}

template <class Real>
double Transition<Real>::add(const FabricView<Real>& fabric, std::vector<Real>& gradient) const {
    const double over = lift(fabric), pull = m_pair.spring_N_per_mm * over;
    double energy = pull * over / 2;
    for (std::size_t side = 0; side < 2; ++side) {
        add_to(gradient, fabric.segments[m_crossing[side].segment].slot, m_basis[side].value,
               Vec<double>(0, 0, side == 0 ? pull : -pull));
    }
    if (m_pair.contact == 0) return energy;
    const std::vector<Laid> first = lay(fabric, 0), second = lay(fabric, 1);
    const double reach = fabric.yarns[m_pair.yarn[0]].radius_mm + fabric.yarns[m_pair.yarn[1]].radius_mm;
    for (const Laid& a : first) {
        for (const Laid& b : second) {
            const Vec<double> apart = a.place - b.place;
            const double s = apart.squaredNorm() / (reach * reach);
            if (s >= 1) continue;
            const ContactLaw<double> law = ContactLaw<double>::at(s, double(fabric.floor));
            const double both = m_pair.contact * a.weight * b.weight;
            energy += both * law.value;
            const Vec<double> force = both * 2 * law.slope / (reach * reach) * apart;
            add_to(gradient, a.slot, a.basis->value, force);
            add_to(gradient, b.slot, b.basis->value, -force);
            const double spread = m_pair.contact * law.value;
            add_to(gradient, a.slot, a.basis->slope, a.tangent * (a.share / a.speed * b.weight * spread));
            add_to(gradient, b.slot, b.basis->slope, b.tangent * (b.share / b.speed * a.weight * spread));
        }
    }
    return energy;
}

template <class Real>
std::vector<std::pair<std::uint32_t, SlotBlocks>> Transition<Real>::curvature(const FabricView<Real>& fabric) const {
    std::vector<std::pair<std::uint32_t, SlotBlocks>> all;
    const auto add_block = [&](std::uint32_t segment, const auto& weights, const Mat<double>& block) {
        if (all.empty() || all.back().first != segment) {
            all.emplace_back(segment, SlotBlocks{});
            all.back().second.clear();
        }
        const double w[4]{double(weights[0]), double(weights[1]), double(weights[2]), double(weights[3])};
        all.back().second.add(w, w, block);
    };
    Mat<double> spring = Mat<double>::Zero();
    spring(2, 2) = 2 * m_pair.spring_N_per_mm;
    for (std::size_t side = 0; side < 2; ++side) add_block(m_crossing[side].segment, m_basis[side].value, spring);
    if (m_pair.contact == 0) return all;
    const std::array<std::vector<Laid>, 2> laid{lay(fabric, 0), lay(fabric, 1)};
    const double reach = fabric.yarns[m_pair.yarn[0]].radius_mm + fabric.yarns[m_pair.yarn[1]].radius_mm;
    for (std::size_t side = 0; side < 2; ++side) {
        for (const Laid& a : laid[side]) {
            Mat<double> sum = Mat<double>::Zero();
            for (const Laid& b : laid[1 - side]) {
                const Vec<double> apart = a.place - b.place;
                if (apart.squaredNorm() >= reach * reach) continue;
                const PairCurvature<double> pair =
                    pair_curvature(apart.squaredNorm(), reach * reach, double(fabric.floor), true);
                sum += 2 * m_pair.contact * a.weight * b.weight *
                       (pair.side * Mat<double>::Identity() + pair.along * apart * apart.transpose());
            }
            add_block(a.segment, a.basis->value, sum);
        }
    }
    return all;
}

template class Transition<float>;
template class Transition<double>;

}  // namespace weave::sim
