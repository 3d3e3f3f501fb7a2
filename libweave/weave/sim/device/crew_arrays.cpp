#include <weave/sim/device/crew_arrays.hpp>

#include <weave/sim/device/relax_device.hpp>
#include <weave/sim/hierarchy.hpp>
#include <weave/sim/relax.hpp>

namespace weave::sim {

namespace {

/// Vectors of rows that steps and conjugate gradients need at once (CrewRoom).
constexpr std::size_t vectors_of_rows = 9;

}  // namespace

template <class Real>
CrewArrays<Real>::CrewArrays(Memory& memory, Energy<double>& energy, const std::vector<double>& state)
    : m_cloth(memory, energy.fabric(), state), m_lists(memory, m_cloth.view(), energy.first_weights(state)),
      m_curvature(memory, m_cloth.view()), m_pieces(memory, Hierarchy(rows_of_yarns(energy.fabric()), places_of(energy.fabric()))),
      m_numbers(3 * std::size_t(m_cloth.view().rows)), m_contact(memory, energy.fabric().samples()),
      m_energy(memory, energy.fabric().segments()), m_share(memory, energy.fabric().segments()), m_state(memory, state), m_before(memory, state.size()),
      m_products(memory, places_for_pairs * places_for_pairs), m_sums(memory, most_sums), m_pair_share(memory, most_pairs),
      m_by_segment(memory, 12 * energy.fabric().segments()), m_vectors(memory, vectors_of_rows * m_numbers),
      m_pair_change(memory, places_for_pairs * m_numbers), m_pair_bend(memory, places_for_pairs * m_numbers),
      m_moved(memory, energy.fabric().samples()), m_key(memory, m_cloth.view().rows), m_reference_floor_N(force_of_yarns(energy.fabric().scene())) {}

template <class Real>
CrewRoom<Real> CrewArrays<Real>::room() const {
    CrewRoom<Real> room;
    room.cloth = m_cloth.view();
    room.lists = m_lists.room();
    room.forces = {m_contact.view(), m_energy.view(), m_by_segment.view()};
    room.curvature = m_curvature.view();
    room.pieces = m_pieces.view();
    room.pairs = {m_numbers, m_pair_change.view(), m_pair_bend.view(), m_products.view(), m_sums.view(), m_pair_share.view()};
    room.moved = m_moved.view();
    room.share = m_share.view();
    room.state = m_state.view();
    room.before = m_before.view();
    std::size_t at = 0;
    for (View<Real>* vector : {&room.gradient, &room.trial, &room.change, &room.cut, &room.residual, &room.solved, &room.direction,
                               &room.step, &room.product})
        *vector = m_vectors.view().slice(m_numbers * at++, m_numbers);
    room.key = m_key.view();
    room.reference_floor_N = m_reference_floor_N;
    return room;
}

template <class Real>
void CrewArrays<Real>::grow(CrewState& state) {
    switch (state.lacking) {
        case Lacking::nothing: return;
        case Lacking::lists: m_lists.grow(state.lists); break;
        case Lacking::curvature: m_curvature.grow(); break;
        case Lacking::pieces: m_pieces.grow(); break;
    }
    state.shape_of_build = 0;
}

template <class Real>
std::size_t CrewArrays<Real>::bytes() const {
    return m_cloth.bytes() + m_lists.bytes() + m_curvature.bytes() + m_pieces.bytes() + m_contact.bytes() + m_energy.bytes() +
           m_share.bytes() + m_state.bytes() + m_before.bytes() + m_products.bytes() + m_sums.bytes() + m_pair_share.bytes() +
           m_by_segment.bytes() + m_vectors.bytes() + m_pair_change.bytes() + m_pair_bend.bytes() + m_moved.bytes() + m_key.bytes();
}

bool device_can_relax(const SimScene& scene) {
    return scene.friction == 0 && !scene.transition;
}

// More than relaxations of the samples took, in all fidelities and with up to 40 points a key point (tests/device/foreseen.cpp): a
// matrix has the more blocks in a row the more segments fit into a yarn's thickness. What does not fit after all is told by
// CrewArrays and goes on on the processor (backend.cpp).
std::size_t device_bytes(const Fabric<double>& fabric) {
    constexpr double a_cloth = 1e6, a_sample = 900, a_segment = 8'000, and_by_thickness = 1'000;
    double bytes = a_cloth + a_sample * static_cast<double>(fabric.samples());
    for (std::size_t y = 0; y < fabric.yarns().size(); ++y) {
        const auto segments = static_cast<double>(fabric.yarns()[y].segments);
        const SimYarn& yarn = fabric.scene().yarns[y];
        const double within_thickness = yarn.rest_mm > 0 ? 2 * yarn.radius_mm * segments / yarn.rest_mm : 1;
        bytes += segments * (a_segment + and_by_thickness * within_thickness);
    }
    return static_cast<std::size_t>(bytes);
}

template class CrewArrays<float>;
template class CrewArrays<double>;

}  // namespace weave::sim
