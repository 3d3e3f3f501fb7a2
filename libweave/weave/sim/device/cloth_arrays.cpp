#include <weave/sim/device/cloth_arrays.hpp>

#include <algorithm>
#include <array>

namespace weave::sim {

namespace {

/// Below a tenth of the reach the contact law goes on linearly.
constexpr double contact_floor = 0.01;
/// Radii within this factor share a grid of cells.
constexpr double class_ratio = 1.5;
/// How many times its own size the cloth may grow before places can no longer be counted.
constexpr double room_to_move = 4;

template <class Real>
Basis<Real> as(const Basis<double>& basis) {
    Basis<Real> same;
    for (int c = 0; c < 4; ++c) {
        same.value[c] = static_cast<Real>(basis.value[c]);
        same.slope[c] = static_cast<Real>(basis.slope[c]);
        same.bend[c] = static_cast<Real>(basis.bend[c]);
    }
    return same;
}

template <class Real>
YarnConstants<Real> as(const YarnConstants<double>& y) {
    return {static_cast<Real>(y.radius_mm), static_cast<Real>(y.stretch_N), static_cast<Real>(y.bending),
            static_cast<Real>(y.tension_N), static_cast<Real>(y.evenness_N), static_cast<Real>(y.rest_mm),
            static_cast<Real>(y.root_k),    y.supply,
            y.samples,                      y.basis};
}

template <class Real>
Gauss<Real> as(const Gauss<double>& gauss) {
    Gauss<Real> same;
    for (std::size_t g = 0; g < gauss_points; ++g) {
        same.basis[g] = as<Real>(gauss.basis[g]);
        same.weight[g] = static_cast<Real>(gauss.weight[g]);
    }
    return same;
}

template <class To, class From>
std::vector<To> all_as(const std::vector<From>& values) {
    std::vector<To> same;
    same.reserve(values.size());
    for (const From& value : values) {
        if constexpr (std::is_same_v<From, To>) same.push_back(value);
        else same.push_back(as<decltype(To::radius_mm)>(value));
    }
    return same;
}

/// The greatest radius of each class, rising.
std::vector<double> classes_of(const SimScene& scene) {
    std::vector<double> radii, greatest;
    for (const SimYarn& yarn : scene.yarns) radii.push_back(yarn.radius_mm);
    std::ranges::sort(radii);
    double bound = -1;
    for (const double radius : radii) {
        if (radius > bound) greatest.push_back(radius), bound = radius * class_ratio;
        greatest.back() = radius;
    }
    return greatest;
}

}  // namespace

template <class Real>
ClothArrays<Real>::ClothArrays(Memory& memory, const Fabric<double>& fabric, const std::vector<double>& state)
    : m_segment(memory, fabric.segment_places()), m_yarn(memory), m_span(memory), m_basis(memory), m_gauss(memory, 1),
      m_segment_of_sample(memory), m_yarn_of_slot(memory, fabric.yarn_of_slot()), m_yarn_of_row(memory), m_slot_of_row(memory),
      m_first_slot_of_row(memory), m_shares(memory), m_slots_of_row(memory), m_spheres(memory, spheres_of<Real>(fabric.scene())),
      m_weight_N(memory), m_class_radius(memory, classes_of(fabric.scene())) {
    lay_rows(memory, fabric);
    lay_yarns(memory, fabric);
    m_gauss.put(std::array{as<Real>(fabric.gauss())});
    std::vector<Basis<Real>> bases;
    for (const Basis<double>& basis : fabric.bases()) bases.push_back(as<Real>(basis));
    m_basis = Array<Basis<Real>>(memory, bases);
    m_view.slots = static_cast<std::uint32_t>(fabric.slots());
    m_view.rows = static_cast<std::uint32_t>(m_slot_of_row.size());
    m_view.segments = static_cast<std::uint32_t>(fabric.segments());
    m_view.samples = static_cast<std::uint32_t>(fabric.samples());
    m_view.yarns = static_cast<std::uint32_t>(fabric.yarns().size());
    m_view.segment = m_segment.view();
    m_view.yarn = m_yarn.view();
    m_view.span = m_span.view();
    m_view.basis = m_basis.view();
    m_view.gauss = m_gauss.view();
    m_view.segment_of_sample = m_segment_of_sample.view();
    m_view.yarn_of_slot = m_yarn_of_slot.view();
    m_view.yarn_of_row = m_yarn_of_row.view();
    m_view.slot_of_row = m_slot_of_row.view();
    m_view.shares = m_shares.view();
    m_view.first_slot_of_row = m_first_slot_of_row.view();
    m_view.slots_of_row = m_slots_of_row.view();
    m_view.spheres = m_spheres.view();
    m_view.fields = static_cast<std::uint32_t>(m_spheres.size());
    m_view.weight_N = m_weight_N.view();
    m_view.floor = static_cast<Real>(contact_floor);
    m_view.least_reach_mm = fabric.least_reach();
    m_view.greatest_radius_mm = fabric.greatest_radius();
    m_view.classes = static_cast<std::uint32_t>(m_class_radius.size());
    m_view.class_radius_mm = m_class_radius.view();
    for (std::size_t k = 0; k < 2; ++k)
        m_view.period_mm[k] = fabric.scene().is_periodic[k] ? std::max(0.0, fabric.scene().period_mm[k]) : 0;
    set_scale(fabric, state);
}

template <class Real>
void ClothArrays<Real>::lay_rows(Memory& memory, const Fabric<double>& fabric) {
    const std::vector<std::uint8_t>& moves = fabric.moves();
    std::vector<SlotShares> shares(moves.size(), SlotShares{{0, 0}, {0, 0}});
    std::vector<std::uint32_t> slot_of_row, yarn_of_row;
    for (std::uint32_t slot = 0; slot < moves.size(); ++slot) {
        if (moves[slot] == 0) continue;
        shares[slot] = {{static_cast<std::uint32_t>(slot_of_row.size()), 0}, {1, 0}};
        slot_of_row.push_back(slot);
        yarn_of_row.push_back(fabric.yarn_of_slot()[slot]);
    }
    for (const FollowSlot& follow : fabric.follows()) {
        for (std::size_t k = 0; k < 2; ++k) {
            if (follow.weight[k] == 0 || moves[follow.from[k]] == 0) continue;
            shares[follow.slot].row[k] = shares[follow.from[k]].row[0];
            shares[follow.slot].weight[k] = static_cast<float>(follow.weight[k]);
        }
    }
    std::vector<std::vector<RowSlot>> slots(slot_of_row.size());
    for (std::uint32_t slot = 0; slot < shares.size(); ++slot) {
        for (std::size_t k = 0; k < 2; ++k) {
            if (shares[slot].weight[k] != 0) slots[shares[slot].row[k]].push_back({slot, shares[slot].weight[k]});
        }
    }
    std::vector<std::uint32_t> first{0};
    std::vector<RowSlot> all;
    for (const std::vector<RowSlot>& of_row : slots) {
        all.insert(all.end(), of_row.begin(), of_row.end());
        first.push_back(static_cast<std::uint32_t>(all.size()));
    }
    m_shares = Array<SlotShares>(memory, shares);
    m_slot_of_row = Array<std::uint32_t>(memory, slot_of_row);
    m_yarn_of_row = Array<std::uint32_t>(memory, yarn_of_row);
    m_first_slot_of_row = Array<std::uint32_t>(memory, first);
    m_slots_of_row = Array<RowSlot>(memory, all);
}

template <class Real>
void ClothArrays<Real>::lay_yarns(Memory& memory, const Fabric<double>& fabric) {
    const SimScene& scene = fabric.scene();
    const std::vector<double> classes = classes_of(scene);
    std::vector<YarnConstants<Real>> constants;
    std::vector<YarnSpan> spans;
    std::vector<double> weights;
    std::vector<std::uint32_t> segment_of_sample(fabric.samples());
    std::uint32_t row = 0;
    for (std::size_t y = 0; y < scene.yarns.size(); ++y) {
        const SimYarn& yarn = scene.yarns[y];
        const YarnPlace& place = fabric.yarns()[y];
        constants.push_back(as<Real>(fabric.constants()[y]));
        YarnSpan span{place.first_slot, place.first_segment, place.segments, row, 0, 0, {yarn.turns[0], yarn.turns[1]}, yarn.is_periodic};
        for (std::uint32_t i = 0; i < place.points; ++i) span.rows += fabric.moves()[place.first_slot + 1 + i];
        row += span.rows;
        span.radius_class = static_cast<std::uint32_t>(std::ranges::lower_bound(classes, yarn.radius_mm) - classes.begin());
        spans.push_back(span);
        if (scene.gravity_mm_ms2 != 0) weights.push_back(yarn.gram_per_mm * scene.gravity_mm_ms2 * fabric.constants()[y].rest_mm);
    }
    for (std::uint32_t s = 0; s < fabric.segments(); ++s) {
        const SegmentPlace& segment = fabric.segment_places()[s];
        std::fill_n(segment_of_sample.begin() + segment.sample, fabric.constants()[segment.yarn].samples, s);
    }
    m_yarn = Array<YarnConstants<Real>>(memory, constants);
    m_span = Array<YarnSpan>(memory, spans);
    m_weight_N = Array<double>(memory, weights);
    m_segment_of_sample = Array<std::uint32_t>(memory, segment_of_sample);
}

/// Steps fine enough that cloth several times as large as this one can still be counted, images and all.
template <class Real>
void ClothArrays<Real>::set_scale(const Fabric<double>& fabric, const std::vector<double>& state) {
    double farthest = 1e-6;
    for (std::size_t k = 0; k < 3 && !state.empty(); ++k) {
        double low = state[k], high = state[k];
        for (std::size_t i = k; i < state.size(); i += 3) low = std::min(low, state[i]), high = std::max(high, state[i]);
        m_view.scale.origin[k] = (low + high) / 2;
        const double period = k < 2 ? m_view.period_mm[k] : 0;
        farthest = std::max(farthest, (high - low) / 2 + period + 4 * fabric.greatest_radius());
    }
    m_view.scale.step_mm = room_to_move * farthest / (1 << 30);
}

template <class Real>
std::size_t ClothArrays<Real>::bytes() const {
    return m_segment.bytes() + m_yarn.bytes() + m_span.bytes() + m_basis.bytes() + m_gauss.bytes() + m_segment_of_sample.bytes() +
           m_yarn_of_slot.bytes() + m_yarn_of_row.bytes() + m_slot_of_row.bytes() + m_first_slot_of_row.bytes() + m_shares.bytes() +
           m_slots_of_row.bytes() + m_spheres.bytes() + m_weight_N.bytes() + m_class_radius.bytes();
}

template class ClothArrays<float>;
template class ClothArrays<double>;

}  // namespace weave::sim
