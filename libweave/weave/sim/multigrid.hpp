#pragma once

#include <weave/sim/block_matrix.hpp>
#include <weave/sim/fabric.hpp>

#include <Eigen/Dense>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace weave::sim {

/// Rows of a matrix that follow one another along a yarn; a closed yarn goes on from its last row to its
/// first.
struct YarnRows {
    std::uint32_t first = 0, rows = 0;
    bool is_closed = false;
};

/// The rows of each yarn, one for each of its control points that moves.
template <class Real>
std::vector<YarnRows> rows_of_yarns(const Fabric<Real>& fabric);

/// Where rows lie, seen from above, and the periods of the cloth: 0 where it does not repeat.
struct RowPlaces {
    std::vector<std::array<double, 2>> at;
    std::array<double, 2> period{};
};

template <class Real>
RowPlaces places_of(const Fabric<Real>& fabric);

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
    /// Pieces that a row belongs to, and how much to each: two along a yarn, four nodes of a grid.
    struct Shares {
        std::array<std::uint32_t, 4> of{};
        std::array<double, 4> weight{1, 0, 0, 0};
    };
    /// Rows, the pivots of their matrix, and the levels that they hand on to. All but the first are pieces formed of the
    /// rows of a finer level.
    struct Level {
        std::size_t rows = 0;
        std::vector<Shares> shares;                        ///< per row of the finer level: its pieces here
        std::vector<std::uint32_t> first_member, members;  ///< per piece: its rows in the finer level
        std::vector<double> member_weight;                 ///< of each, how much of it belongs to the piece
        std::vector<std::size_t> coarser;                  ///< indices of levels; none: solved as a whole
        std::vector<double> inverse;                       ///< of each pivot, 9 a row
        BlockMatrix matrix;                                ///< not on the first level, whose matrix is given
        Eigen::LLT<Eigen::MatrixXd> whole;
        std::vector<double> residual, step;
    };

    void add_pieces_of_yarns(std::size_t finer, std::vector<YarnRows>& yarns);
    bool add_grid(std::size_t finer, double spacing, RowPlaces& places);
    void add_grids(std::size_t finer, RowPlaces places);
    void add_level(std::size_t finer, std::vector<Shares> shares, std::size_t pieces);
    [[nodiscard]] static RowPlaces places_of_pieces(const Level& pieces, const RowPlaces& places);
    void invert_pivots(const BlockMatrix& matrix, Level& level) const;
    void coarsen(const BlockMatrix& fine, const Level& level, BlockMatrix& coarse) const;
    void factor(std::size_t number, const BlockMatrix& matrix);
    static void factor_whole(const BlockMatrix& matrix, Level& level);
    void restrict_to(Level& level, const std::vector<double>& fine) const;
    void add_pieces(const Level& level, std::vector<double>& fine) const;
    void solve(std::size_t number, const std::vector<double>& residual, std::vector<double>& step);
    template <class Body>
    void each_row(std::size_t rows, const Body& body) const;

    const Executor& m_executor;
    std::vector<Level> m_levels;
};

}  // namespace weave::sim
