#pragma once

#include <weave/sim/block_matrix.hpp>
#include <weave/sim/fabric.hpp>

#include <Eigen/Dense>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace weave::sim {

/// Rows of a matrix that follow one another along a yarn; a closed strand goes on from its last row to its
/// first.
struct Strand {
    std::uint32_t first = 0, rows = 0;
    bool is_closed = false;
};

/// The rows of each yarn, one for each of its control points that moves.
template <class Real>
std::vector<Strand> strands_of(const Fabric<Real>& fabric);

/// A preconditioner that sees long waves: the sum of what single points do and of what ever longer pieces of
/// yarn do, moving as one, up to whole yarns and bundles of them (Bramble, Pasciak, Xu 1990). A piece hands
/// its movement on to the points between it and the next piece linearly. Symmetric and positive for every
/// matrix, and all of it runs on any number of threads with the same result.
class Multigrid : public Preconditioner {
  public:
    /// Strands follow one another and cover all rows.
    Multigrid(const Executor& executor, std::vector<Strand> strands);

    void factor(const BlockMatrix& matrix);
    void apply(const std::vector<double>& residual, std::vector<double>& step) override;

    [[nodiscard]] std::size_t levels() const { return m_levels.size(); }

  private:
    /// One or two pieces that a row belongs to, and how much.
    struct Shares {
        std::array<std::uint32_t, 2> of{};
        std::array<double, 2> weight{1, 0};
    };
    /// Rows, the pivots of their matrix, and the pieces of the next level that they form.
    struct Level {
        std::size_t rows = 0;
        std::vector<double> inverse;                       ///< of each pivot, 9 a row
        std::vector<Shares> shares;                        ///< empty on the last level
        std::vector<std::uint32_t> first_member, members;  ///< per piece: its rows
        BlockMatrix matrix;                                ///< not on the first level, whose matrix is given
        std::vector<double> residual, step;
    };

    void add_level(std::vector<Strand>& strands);
    void list_members(Level& level, std::size_t pieces) const;
    void invert_pivots(const BlockMatrix& matrix, Level& level) const;
    void coarsen(const BlockMatrix& fine, const Level& level, BlockMatrix& coarse) const;
    void factor_last(const BlockMatrix& matrix);
    void restrict_to(const Level& level, const std::vector<double>& fine, std::vector<double>& coarse) const;
    void add_pieces(const Level& level, const std::vector<double>& coarse, std::vector<double>& fine) const;
    void solve(std::size_t number, const std::vector<double>& residual, std::vector<double>& step);
    template <class Body>
    void each_row(std::size_t rows, const Body& body) const;

    const Executor& m_executor;
    std::vector<Level> m_levels;
    Eigen::LLT<Eigen::MatrixXd> m_last;  ///< of the whole matrix of the last level
};

}  // namespace weave::sim
