#include <weave/sim/device/lists_arrays.hpp>

#include <bit>

namespace weave::sim {

namespace {

/// Room at first: what firm cloth takes, so that few runs begin by making more.
constexpr std::size_t first_neighbours = 48, first_candidates = 160;

std::size_t with_some_more(std::size_t needed) {
    return needed + needed / 4;
}

}  // namespace

template <class Real>
ListsArrays<Real>::ListsArrays(Memory& memory, const ClothView<Real>& cloth, const std::vector<double>& first_weights)
    : m_own(cloth.samples), m_sample(memory), m_built(memory, m_own), m_wide_built(memory, m_own), m_radius(memory),
      m_first_weight(memory, std::vector<Real>(first_weights.begin(), first_weights.end())), m_halo(memory), m_first_image(memory, m_own + 1), m_first(memory, m_own + 1), m_neighbour(memory),
      m_first_candidate(memory, cloth.segments + std::size_t{1}), m_candidate(memory),
      m_first_of_bucket(memory, std::bit_ceil(std::size_t{16} + 2 * m_own) + 1), m_cell_sample(memory), m_cell_key(memory) {
    m_room.first_image = m_first_image.view();
    m_room.first = m_first.view();
    m_room.first_candidate = m_first_candidate.view();
    m_room.built = m_built.view();
    m_room.wide_built = m_wide_built.view();
    m_room.first_weight = m_first_weight.view();
    m_room.cells.first = m_first_of_bucket.view();
    m_room.cells.mask = static_cast<std::uint32_t>(m_first_of_bucket.size() - 2);
    hold_images(m_own / 2 + 16);
    hold_neighbours(first_neighbours * m_own);
    hold_candidates(first_candidates * cloth.segments);
}

template <class Real>
void ListsArrays<Real>::hold_images(std::size_t images) {
    m_room.images = images;
    m_sample.resize(m_own + images);
    m_radius.resize(m_own + images);
    m_halo.resize(images);
    m_cell_sample.resize(m_own + images);
    m_cell_key.resize(m_own + images);
    m_room.sample = m_sample.view();
    m_room.radius = m_radius.view();
    m_room.halo = m_halo.view();
    m_room.cells.sample = m_cell_sample.view();
    m_room.cells.key = m_cell_key.view();
}

template <class Real>
void ListsArrays<Real>::hold_neighbours(std::size_t neighbours) {
    m_room.neighbours = neighbours;
    m_neighbour.resize(neighbours);
    m_room.neighbour = m_neighbour.view();
}

template <class Real>
void ListsArrays<Real>::hold_candidates(std::size_t candidates) {
    m_room.candidates = candidates;
    m_candidate.resize(candidates);
    m_room.candidate = m_candidate.view();
}

template <class Real>
void ListsArrays<Real>::grow(ListsState& state) {
    if (state.needs_images > 0) hold_images(with_some_more(state.needs_images));
    if (state.needs_neighbours > 0) hold_neighbours(with_some_more(state.needs_neighbours));
    if (state.needs_candidates > 0) hold_candidates(with_some_more(state.needs_candidates));
    state.needs_images = state.needs_neighbours = state.needs_candidates = 0;
    state.wide = false;
}

template <class Real>
std::size_t ListsArrays<Real>::bytes() const {
    return m_sample.bytes() + m_built.bytes() + m_wide_built.bytes() + m_radius.bytes() + m_first_weight.bytes() + m_halo.bytes() +
           m_first_image.bytes() + m_first.bytes() + m_neighbour.bytes() + m_first_candidate.bytes() + m_candidate.bytes() +
           m_first_of_bucket.bytes() + m_cell_sample.bytes() + m_cell_key.bytes();
}

template class ListsArrays<float>;
template class ListsArrays<double>;

}  // namespace weave::sim
