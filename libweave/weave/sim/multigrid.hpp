#pragma once

#include <weave/sim/block_matrix.hpp>
#include <weave/sim/hierarchy.hpp>

#include <Eigen/Dense>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace weave::sim {

/// A preconditioner that sees long waves: the sum of what single points do and of what ever longer pieces of
/// yarn do, moving as one, up to whole yarns and bundles of them (Bramble, Pasciak, Xu 1990). A piece hands
/// its movement on to the points between it and the next piece linearly. Symmetric and positive for every
/// matrix, and all of it runs on any number of threads with the same result.
///
/// Yarns that cross do not quite move alike by pieces of each, so that a large sheet's long waves would be missed. For
/// these, the shortest pieces also hand on to the nodes of a grid over the cloth, the same for all yarns, and
/// that to ever coarser grids.
class Multigrid : public Preconditioner {
  public:
    /// The yarns follow one another and cover all rows. Without `places` there are no grids.
    Multigrid(const Executor& executor, std::vector<YarnRows> yarns, RowPlaces places = {});

    void factor(const BlockMatrix& matrix);
    void apply(const std::vector<double>& residual, std::vector<double>& step) override;

    [[nodiscard]] std::size_t levels() const { return m_levels.size(); }

  private:
    /// The numbers of a level of the hierarchy.
    struct Level {
        std::vector<double> inverse;  ///< of each pivot, 9 a row
        BlockMatrix matrix;           ///< not on the first level, whose matrix is given
        Eigen::LLT<Eigen::MatrixXd> whole;
        std::vector<double> residual, step;
    };

    void invert_pivots(const BlockMatrix& matrix, std::vector<double>& inverse) const;
    void coarsen(const BlockMatrix& fine, const PieceLevel& level, BlockMatrix& coarse) const;
    void factor(std::size_t number, const BlockMatrix& matrix);
    static void factor_whole(const BlockMatrix& matrix, Level& level);
    void restrict_to(std::size_t number, const std::vector<double>& fine);
    void add_pieces(std::size_t number, std::vector<double>& fine) const;
    void solve(std::size_t number, const std::vector<double>& residual, std::vector<double>& step);
    template <class Body>
    void each_row(std::size_t rows, const Body& body) const;

    const Executor& m_executor;
    Hierarchy m_hierarchy;
    std::vector<Level> m_levels;
};

}  // namespace weave::sim
