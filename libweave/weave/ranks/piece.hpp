#pragma once

#include <weave/ranks/cut.hpp>
#include <weave/sim/block_matrix.hpp>
#include <weave/sim/energy.hpp>
#include <weave/sim/hessian.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace weave::ranks {

/// A block's piece of cloth as the simulator sees it: its own points and, as guests, those that its segments reach or may touch.
/// Yarns are cut where no more of them is needed. What is found of its own points is whole; of its guests it is not.
class Piece {
  public:
    static constexpr std::uint32_t none = 0xffffffffU;

    Piece(const Cut& cut, const Part& part, std::vector<Met> guests, const sim::Executor& executor);
    Piece(const Piece&) = delete;
    Piece& operator=(const Piece&) = delete;

    [[nodiscard]] const std::vector<Met>& guests() const { return m_guests; }
    [[nodiscard]] sim::Energy<double>& energy() { return m_energy; }
    [[nodiscard]] sim::Hessian<double>& hessian() { return m_hessian; }
    [[nodiscard]] const sim::Fabric<double>& fabric() const { return m_fabric; }

    /// Slots from the numbers of own points and of guests, three each; a state's guests lie moved by their turns and periods.
    void lay_state(std::span<const double> own, std::span<const double> guests, std::vector<double>& slots) const;
    void lay_change(std::span<const double> own, std::span<const double> guests, std::vector<double>& slots) const;
    /// The numbers of own points among the slots.
    void take(const std::vector<double>& slots, std::span<double> own) const;

    /// Row of the matrix of each own point, and of each guest; `none` where it does not move.
    [[nodiscard]] const std::vector<std::uint32_t>& row_of_own() const { return m_row_of_own; }
    [[nodiscard]] const std::vector<std::uint32_t>& row_of_guest() const { return m_row_of_guest; }

    /// What each yarn of fabric() is a run of: its yarn in the cloth, seen so many periods away, from this point along it on.
    struct Strand {
        std::uint32_t yarn = 0;
        std::array<std::int16_t, 2> image{};
        std::int64_t first = 0;
    };
    [[nodiscard]] const std::vector<Strand>& strands() const { return m_strands; }
    [[nodiscard]] const std::vector<std::uint32_t>& slot_of_own() const { return m_slot_of_own; }

    std::vector<double> state;  ///< by slot, as evaluated last
    sim::BlockMatrix matrix;    ///< of all rows; those of guests are not whole

  private:
    struct Yarns;
    Piece(const Cut& cut, std::vector<Met> guests, const sim::Executor& executor, const Yarns& yarns);

    std::vector<Met> m_guests;
    std::vector<Vec3> m_moved;  ///< of each guest, from where it lies in its own block
    std::vector<Strand> m_strands;
    std::vector<std::uint32_t> m_slot_of_own, m_slot_of_guest, m_row_of_own, m_row_of_guest;
    sim::Fabric<double> m_fabric;
    sim::Energy<double> m_energy;
    sim::Hessian<double> m_hessian;
};

/// How far a point that is met so lies from itself.
Vec3 moved_by(const Cut& cut, const Met& met);

}  // namespace weave::ranks
