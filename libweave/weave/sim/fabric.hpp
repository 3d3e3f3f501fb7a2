#pragma once

#include <weave/sim/bodies.hpp>
#include <weave/sim/scene.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace weave::sim {

/// Control slots of one yarn: its control points, with the slots beyond its ends that its first and last segments
/// reach. Slot first + 1 + i is control point i.
struct YarnPlace {
    std::uint32_t first_slot = 0, slots = 0, points = 0;
    std::uint32_t first_segment = 0, segments = 0;
    std::uint32_t skipped = 0;  ///< slots before its first segment: one where it is cut off
};

/// A slot beyond a yarn's end that follows from one or two of its control points: weight·point + …, moved by whole
/// periods.
struct FollowSlot {
    std::uint32_t slot = 0;
    std::array<std::uint32_t, 2> from{};
    std::array<double, 2> weight{1, 0};
    int turns = 0;  ///< times the yarn's shift
};

/// Length of the polygon of a yarn's control points, mm.
double control_length(const SimYarn& yarn);

/// An image of an own contact sample, some periods away.
struct HaloSample {
    std::uint32_t of = 0;                ///< own sample
    std::array<std::int16_t, 2> image{};  ///< periods in x and y
};

/// The yarns as structure of arrays: what bodies read. A state is a vector of 3 numbers a slot; vectors of changes have
/// zeros at frozen and following slots.
template <class Real>
class Fabric {
  public:
    explicit Fabric(const SimScene& scene);

    [[nodiscard]] const SimScene& scene() const { return m_scene; }
    [[nodiscard]] std::size_t slots() const { return m_moves.size(); }
    [[nodiscard]] std::size_t points() const { return m_points; }
    [[nodiscard]] std::size_t segments() const { return m_segments.size(); }
    [[nodiscard]] std::size_t samples() const { return m_samples; }
    [[nodiscard]] const std::vector<YarnPlace>& yarns() const { return m_places; }
    [[nodiscard]] const std::vector<SegmentPlace>& segment_places() const { return m_segments; }
    [[nodiscard]] const std::vector<YarnConstants<Real>>& constants() const { return m_constants; }
    [[nodiscard]] const std::vector<Basis<Real>>& bases() const { return m_bases; }
    [[nodiscard]] const Gauss<Real>& gauss() const { return m_gauss; }
    [[nodiscard]] const std::vector<FollowSlot>& follows() const { return m_follows; }
    /// Whether a slot is a control point that may move.
    [[nodiscard]] const std::vector<std::uint8_t>& moves() const { return m_moves; }
    /// Whether a slot is a control point that belongs to another part of the cloth (SimYarn::guests).
    [[nodiscard]] bool is_guest(std::size_t slot) const { return !m_guests.empty() && m_guests[slot] != 0; }
    /// Whether a segment counts as this part's: the control point that it begins at does.
    [[nodiscard]] bool is_own(std::size_t segment) const { return !is_guest(m_segments[segment].slot + 1); }
    /// Whether a segment acts on a control point that is no guest.
    [[nodiscard]] bool is_felt(std::size_t segment) const {
        const std::size_t slot = m_segments[segment].slot;
        return m_guests.empty() || !(is_guest(slot) && is_guest(slot + 1) && is_guest(slot + 2) && is_guest(slot + 3));
    }
    /// Index of the yarn that each slot belongs to.
    [[nodiscard]] const std::vector<std::uint32_t>& yarn_of_slot() const { return m_yarn_of_slot; }
    /// Smallest sum of two radii, and the greatest radius, mm.
    [[nodiscard]] double least_reach() const { return m_least_reach; }
    [[nodiscard]] double greatest_radius() const { return m_greatest_radius; }

    /// The state of the scene's control points.
    [[nodiscard]] std::vector<Real> state() const;
    /// The control points of a state, yarn by yarn.
    [[nodiscard]] std::vector<std::vector<Vec3>> control(const std::vector<Real>& state) const;
    /// Length of a yarn's centreline in a state.
    [[nodiscard]] double length_mm(const std::vector<Real>& state, std::size_t yarn) const;
    /// Places the following slots of a state.
    void follow(std::vector<Real>& state) const;
    /// The same for a change of state: no periods are added.
    void follow_change(std::vector<Real>& change) const;
    /// Adds what following slots have gathered to the points that they follow, and clears them, frozen slots and guests.
    void fold(std::vector<Real>& gradient) const;

  private:
    void add_yarn(const SimYarn& yarn);
    void add_follows(const SimYarn& yarn, const YarnPlace& place);
    void add_guests(const SimYarn& yarn, const YarnPlace& place);
    std::uint32_t basis_for(std::uint32_t samples);

    SimScene m_scene;
    std::vector<YarnPlace> m_places;
    std::vector<SegmentPlace> m_segments;
    std::vector<YarnConstants<Real>> m_constants;
    std::vector<Basis<Real>> m_bases;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> m_basis_of_samples;
    Gauss<Real> m_gauss;
    std::vector<FollowSlot> m_follows;
    std::vector<std::uint8_t> m_moves;
    std::vector<std::uint8_t> m_guests;  ///< per slot; empty where there are none. A following slot is one with what it follows
    std::vector<std::uint32_t> m_yarn_of_slot;
    std::size_t m_points = 0, m_samples = 0;
    double m_least_reach = 0, m_greatest_radius = 0;
};

extern template class Fabric<float>;
extern template class Fabric<double>;

}  // namespace weave::sim
