#pragma once

#include <weave/sim/block_matrix.hpp>
#include <weave/sim/cloth.hpp>
#include <weave/sim/energy.hpp>
#include <weave/sim/hessian_terms.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace weave::sim {

/// Second derivatives of the energy by the control points that move, one row of blocks each.
template <class Real>
class Hessian {
  public:
    explicit Hessian(const Fabric<Real>& fabric);

    [[nodiscard]] std::size_t rows() const { return m_slot_of_row.size(); }
    [[nodiscard]] const std::vector<std::uint32_t>& slot_of_row() const { return m_slot_of_row; }

    /// Fills `matrix`, at the state of the latest Energy::evaluate. Its shape is made anew when the neighbours were.
    void assemble(Energy<Real>& energy, const std::vector<Real>& state, Curvature curvature, BlockMatrix& matrix);

    /// Numbers of the rows of a vector of slots, and back (other slots: 0, then followed).
    void to_rows(const std::vector<Real>& slots, std::vector<double>& rows) const;
    void to_slots(const std::vector<double>& rows, std::vector<Real>& slots) const;

  private:
    /// One control point that a slot stands for, with its share.
    struct Share {
        std::uint32_t row;
        float weight;
    };
    struct Chunk {
        std::uint32_t first, last;  ///< segments
    };
    struct Scratch;

    void make_shares();
    void make_chunks();
    void make_shape(Energy<Real>& energy, BlockMatrix& matrix);
    void list_columns(std::uint32_t row, std::vector<std::uint32_t>& columns) const;
    void list_near_segments(Energy<Real>& energy);
    WEAVE_INLINE void add_segment(Energy<Real>& energy, const FabricView<Real>& fabric, std::uint32_t index,
                     BlockMatrix& matrix, Scratch& scratch) const;
    struct Meeting;
    void lay_pulls(const Executor& executor, const FabricView<Real>& fabric);
    WEAVE_INLINE void add_sample(const Neighbours<Real>& neighbours, const FabricView<Real>& fabric, std::uint32_t index,
                    std::uint32_t k, Scratch& scratch) const;
    void add_friction(Energy<Real>& energy, const FabricView<Real>& fabric, std::uint32_t index, std::uint32_t k,
                      Scratch& scratch) const;
    WEAVE_INLINE SlotBlocks& other_sum(std::uint32_t index, std::uint32_t other, Scratch& scratch) const;
    WEAVE_INLINE void add_meeting(std::uint32_t index, const Meeting& meeting, Scratch& scratch) const;
    void list_mirrored(const BlockMatrix& matrix);
    void mirror(const Executor& executor, BlockMatrix& matrix) const;
    WEAVE_INLINE void scatter(std::uint32_t segment, std::uint32_t other, const SlotBlocks& local, BlockMatrix& matrix) const;

    const Fabric<Real>& m_fabric;
    Gauss<double> m_gauss;
    std::vector<Sphere<double>> m_spheres;
    std::vector<Basis<double>> m_bases;
    std::vector<YarnConstants<double>> m_constants;
    std::vector<std::uint32_t> m_slot_of_row;
    std::vector<std::uint32_t> m_first_share;  ///< per slot, and one more
    std::vector<Share> m_shares;
    std::vector<std::uint32_t> m_first_row;    ///< per segment whose four slots are rows that follow one another
    std::vector<std::vector<Chunk>> m_chunks;  ///< by colour: chunks of one colour share no row
    std::vector<std::uint32_t> m_first_segment{0}, m_segments_of_row;  ///< per row: the segments that reach it
    std::vector<std::uint32_t> m_first_near, m_near;  ///< per segment: the segments that may touch it
    std::vector<Vec<double>> m_pulls;                 ///< per own sample: derivative of its weight by its tangent
    std::vector<std::uint32_t> m_end_of_yarn;         ///< per row: the first row after its yarn
    /// Blocks that belong to a yarn of higher number are those of that yarn's row: from which block on in each row, and
    /// where the others lie.
    std::vector<std::uint32_t> m_first_mirrored, m_mirrored_from;
    std::size_t m_shape_of_build = 0;  ///< builds of the neighbours, and renewals of friction
};

extern template class Hessian<float>;
extern template class Hessian<double>;

}  // namespace weave::sim
