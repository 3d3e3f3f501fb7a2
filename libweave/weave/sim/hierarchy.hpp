#pragma once

#include <weave/sim/fabric.hpp>

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

/// Pieces that a row belongs to, and how much to each: two along a yarn, four nodes of a grid.
struct PieceShares {
    std::array<std::uint32_t, 4> of{};
    std::array<double, 4> weight{1, 0, 0, 0};
};

/// Rows and the levels that they hand on to. All but those of the first level are pieces formed of the rows of a finer one.
struct PieceLevel {
    std::size_t rows = 0;
    std::vector<PieceShares> shares;                   ///< per row of the finer level: its pieces here
    std::vector<std::uint32_t> first_member, members;  ///< per piece: its rows in the finer level
    std::vector<double> member_weight;                 ///< of each, how much of it belongs to the piece
    std::vector<std::size_t> coarser;                  ///< indices of levels; none: solved as a whole
};

/// The pieces of yarn, bundles of yarns and nodes of grids that a Multigrid works with. They follow from where rows lie
/// alone, not from a matrix.
class Hierarchy {
  public:
    /// So few rows are solved as a whole. A device inverts them one after the other while the rest of it waits: with 128 that would
    /// be a tenth of its time; on the processor 32 to 128 cost the same steps, to a few per cent more or less.
    static constexpr std::size_t usual_last_rows = 64;

    /// The yarns follow one another and cover all rows. Without `places` there are no grids.
    explicit Hierarchy(std::vector<YarnRows> yarns, RowPlaces places = {}, std::size_t last_rows = usual_last_rows);

    /// The rows themselves first; a level's coarser ones come after it.
    [[nodiscard]] const std::vector<PieceLevel>& levels() const { return m_levels; }

  private:
    void add_pieces_of_yarns(std::size_t finer, std::vector<YarnRows>& yarns);
    bool add_grid(std::size_t finer, double spacing, RowPlaces& places);
    void add_grids(std::size_t finer, RowPlaces places);
    void add_level(std::size_t finer, std::vector<PieceShares> shares, std::size_t pieces);
    [[nodiscard]] static RowPlaces places_of_pieces(const PieceLevel& pieces, const RowPlaces& places);

    std::size_t m_last_rows;
    std::vector<PieceLevel> m_levels;
};

}  // namespace weave::sim
