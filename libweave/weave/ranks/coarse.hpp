#pragma once

#include <weave/ranks/comm.hpp>
#include <weave/ranks/cut.hpp>
#include <weave/ranks/piece.hpp>

#include <Eigen/SparseCholesky>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace weave::ranks {

/// What moves whole blocks: a grid over the cloth, some nodes a block, to whose four nodes around it each point belongs by where
/// it is planned. All ranks have all of it, and solve it alike.
class CoarseGrid {
  public:
    CoarseGrid(Comm& comm, const Cut& cut, const std::vector<Part>& parts);

    /// Makes the grid's matrix of those of the pieces, one for each block of this rank. All ranks call it at once, as apply().
    void factor(const std::vector<std::unique_ptr<Piece>>& pieces, const std::vector<Part>& parts);
    /// Adds what the grid makes of the residual of own points that move (three numbers each, block after block) to the step.
    void apply(std::span<const double> residual, std::span<double> step);

    [[nodiscard]] std::size_t nodes() const { return m_nodes[0] * m_nodes[1]; }

  private:
    struct Shares {
        std::array<std::uint32_t, 4> node{};
        std::array<double, 4> weight{};
    };
    struct Block {
        std::vector<Shares> rows;          ///< of own points that move
        std::vector<std::uint32_t> nodes;  ///< that have a share in one of them
    };
    [[nodiscard]] Shares shares_of(const Point& point) const;
    void set_matrix(const std::vector<Comm::Packet>& sums);

    Comm& m_comm;
    std::array<std::size_t, 2> m_nodes{};
    std::array<double, 2> m_low{}, m_step{};
    std::array<bool, 2> m_is_closed{};
    std::vector<Block> m_blocks;
    std::vector<std::size_t> m_counts;            ///< numbers that each rank tells of its residual
    std::vector<std::uint32_t> m_nodes_told;      ///< nodes of all ranks' blocks, one after another
    std::vector<double> m_told, m_all, m_right;
    Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> m_solver;
};

}  // namespace weave::ranks
