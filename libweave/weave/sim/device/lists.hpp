#pragma once

#include <weave/sim/device/crew.hpp>
#include <weave/sim/device/lists_bodies.hpp>
#include <weave/sim/device/lists_view.hpp>
#include <weave/sim/device/rows.hpp>

#include <cstddef>
#include <cstdint>

namespace weave::sim {

/// Arrays of the lists; those that may turn out too short with how much they hold.
template <class Real>
struct ListsRoom {
    View<Sample<Real>> sample;         ///< own and images
    View<Real> radius;                 ///< the same
    View<HaloSample> halo;             ///< images
    View<std::uint32_t> first_image;   ///< per own sample, and one more
    View<std::uint32_t> first, neighbour;
    View<std::uint32_t> first_candidate, candidate;  ///< per segment: samples that may come near it
    View<Sample<Real>> built, wide_built;            ///< own samples when each list was made
    View<const Real> first_weight;                   ///< of own samples, see Energy::first_weights()
    CellsView cells;
    std::size_t images = 0, neighbours = 0, candidates = 0;  ///< so many fit
};

/// Numbers that the lists go on with. Of the last three: what did not fit, 0 where all did.
struct ListsState {
    std::uint32_t halo = 0, builds = 0;
    bool made = false, wide = false;  ///< the lists are made; the list of candidates is
    std::size_t needs_images = 0, needs_neighbours = 0, needs_candidates = 0;
};

/// Contact samples of a state and the lists of those that may touch: as sim/neighbours.hpp makes them, by any crew. For each own
/// sample every sample nearer than the sum of the two radii and a skin is listed, but for those of the same yarn within half a turn of it
/// along the yarn. A wider list of what may come near each segment lasts longer; most lists are made from it.
template <class Real>
class Lists {
  public:
    WEAVE_HD Lists(const ClothView<Real>& cloth, const ListsRoom<Real>& room, const ListsState& state)
        : m_cloth(cloth), m_room(room), m_state(state) {}

    /// Lays the samples of a state and makes the lists anew where they no longer hold. False where an array is too short: then
    /// there are no lists, and state() tells what is needed.
    WEAVE_ANYWHERE template <class Crew>
    WEAVE_HD bool update(Crew& crew, const View<const double>& state) {
        crew.each(m_cloth.samples, LaySamples<Real>{m_cloth, state, m_room.sample});
        if (m_state.made && gone_since(crew, m_room.built) <= square(skin_mm() / 2)) {
            move_halo(crew);
            return true;
        }
        return build(crew);
    }

    [[nodiscard]] WEAVE_HD ListsView<Real> view() const {
        return {m_room.sample, m_room.radius, m_room.halo, m_cloth.samples, m_room.first, m_room.neighbour};
    }
    [[nodiscard]] WEAVE_HD const ListsState& state() const { return m_state; }
    /// How much farther than they touch samples are listed.
    [[nodiscard]] WEAVE_HD double skin_mm() const { return skin_share * m_cloth.least_reach_mm; }

  private:
    static constexpr double skin_share = 0.25, travel_share = 0.5;  ///< as on the processor (neighbours.cpp)

    WEAVE_HD static double square(double x) { return x * x; }
    WEAVE_HD double wide_skin_mm() const { return (skin_share + travel_share) * m_cloth.least_reach_mm; }

    /// The farthest that a sample has gone since, squared, mm².
    WEAVE_ANYWHERE template <class Crew>
    WEAVE_HD double gone_since(Crew& crew, const View<Sample<Real>>& built) {
        return crew.greatest(m_cloth.samples, GoneSince<Real>{m_room.sample, built, static_cast<Real>(m_cloth.scale.step_mm)});
    }

    WEAVE_ANYWHERE template <class Crew>
    WEAVE_HD void move_halo(Crew& crew) {
        crew.each(m_state.halo, MoveImages<Real>{m_cloth, m_room.halo, m_room.sample});
    }

    WEAVE_ANYWHERE template <class Crew>
    WEAVE_HD bool build(Crew& crew) {
        if (!m_state.wide || gone_since(crew, m_room.wide_built) > square((wide_skin_mm() - skin_mm()) / 2)) {
            if (!build_wide(crew)) return lacks_room();
        } else {
            move_halo(crew);
        }
        if (!list_neighbours(crew)) return lacks_room();
        crew.each(m_cloth.samples, Copy<Sample<Real>>{m_room.sample, m_room.built});
        ++m_state.builds;
        m_state.made = true;
        return true;
    }

    WEAVE_HD bool lacks_room() {
        m_state.made = m_state.wide = false;
        return false;
    }

    WEAVE_ANYWHERE template <class Crew>
    WEAVE_HD bool build_wide(Crew& crew) {
        m_state.wide = false;
        if (!find_images(crew)) return false;
        fill_cells(crew);
        const FindCandidates<Real> find{m_cloth, view(), m_room.cells, wide_skin_mm(), m_room.first_candidate, m_room.candidate, false};
        crew.each(m_cloth.segments + 1, find);
        const std::size_t total = crew.scan(m_room.first_candidate, m_cloth.segments + 1);
        m_state.needs_candidates = total > m_room.candidates ? total : 0;
        if (m_state.needs_candidates > 0) return false;
        crew.each(m_cloth.segments, find.filling());
        crew.each(m_cloth.segments, SortCandidates<Real>{view(), m_room.first_candidate, m_room.candidate});
        crew.each(m_cloth.samples, Copy<Sample<Real>>{m_room.sample, m_room.wide_built});
        m_state.wide = true;
        return true;
    }

    /// Images of samples that come within reach of the box that holds all own samples.
    WEAVE_ANYWHERE template <class Crew>
    WEAVE_HD bool find_images(Crew& crew) {
        const double reach = 2 * m_cloth.greatest_radius_mm + wide_skin_mm();
        FindImages<Real> find{m_cloth, m_room.sample, {0, 0}, {0, 0}, m_room.first_image, m_room.halo, m_room.radius, false};
        for (int k = 0; k < 2; ++k) {
            find.low[k] = crew.least(m_cloth.samples, PlaceAlong<Real>{m_cloth, m_room.sample, k}, 1e300) - reach;
            find.high[k] = -crew.least(m_cloth.samples, PlaceAlong<Real>{m_cloth, m_room.sample, k, -1}, 1e300) + reach;
        }
        crew.each(m_cloth.samples + 1, find);
        const std::size_t total = crew.scan(m_room.first_image, m_cloth.samples + 1);
        m_state.needs_images = total > m_room.images ? total : 0;
        if (m_state.needs_images > 0) return false;
        m_state.halo = static_cast<std::uint32_t>(total);
        crew.each(m_cloth.samples, find.filling());
        move_halo(crew);
        return true;
    }

    WEAVE_ANYWHERE template <class Crew>
    WEAVE_HD void fill_cells(Crew& crew) {
        const std::uint32_t all = m_cloth.samples + m_state.halo;
        crew.each(std::size_t(m_room.cells.mask) + 2, EmptyCells{m_room.cells});
        const SortIntoCells<Real> sort{m_cloth, view(), m_room.cells, wide_skin_mm(), false};
        crew.each(all, sort);
        crew.scan(m_room.cells.first, std::size_t(m_room.cells.mask) + 2);
        crew.each(all, sort.filling());
    }

    WEAVE_ANYWHERE template <class Crew>
    WEAVE_HD bool list_neighbours(Crew& crew) {
        const ListNeighbours<Real> list{m_cloth, view(), skin_mm(), m_room.first_weight, m_room.first_candidate, m_room.candidate, false};
        crew.each(m_cloth.samples + 1, list);
        const std::size_t total = crew.scan(m_room.first, m_cloth.samples + 1);
        m_state.needs_neighbours = total > m_room.neighbours ? total : 0;
        if (m_state.needs_neighbours > 0) return false;
        crew.each(m_cloth.samples, list.filling());
        return true;
    }

    ClothView<Real> m_cloth;
    ListsRoom<Real> m_room;
    ListsState m_state;
};

}  // namespace weave::sim
