#pragma once

#include <weave/block/block.hpp>
#include <weave/block/extent.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace weave {

/// Repeats a block x times along the rows, y times along the columns and z times in height (paper, Algorithm
/// 5 without its misprinted factor). Within each source stack the yarns keep their order. Counts must be at
/// least 1.
Result<Block> tile(const Block& block, std::size_t x, std::size_t y, std::size_t z);

/// What tile() refuses of a block of this extent.
Status check_tile(const Extent& of, std::size_t x, std::size_t y, std::size_t z);

/// A face of a block. +x lies after the last row, +y after the last column, +z on top.
enum class Face : std::uint8_t { plus_x, minus_x, plus_y, minus_y, plus_z, minus_z };

/// `+x`, `-x` and so on, by value of Face.
const std::vector<std::string>& face_names();

/// Joins `other` to that face of `block` (paper, Algorithms 2 and 3). In x both need the same p, in y the
/// same t, in z the same numbers of rows and columns; an error names the first row or column that differs,
/// and which block has what. `names`, if given, are what it calls the two.
Result<Block> attach(const Block& block, const Block& other, Face face,
                     std::span<const std::string> names = {});

/// Which block each stack is taken from: one entry per stack of the result. Row 0 is the bottom row of the
/// picture, column 0 its left.
struct StencilMap {
    std::size_t rows = 0, columns = 0;
    std::vector<std::uint16_t> blocks;  ///< rows * columns, row by row

    [[nodiscard]] std::span<const std::uint16_t> row(std::size_t i) const {
        return std::span(blocks).subspan(i * columns, columns);
    }
    friend bool operator==(const StencilMap&, const StencilMap&) = default;
};

/// Merges blocks by a stencil (paper, Algorithm 4): cell (i, j) is cell (i mod r, j mod c) of the block that
/// the map names there. Errors: an empty map, an entry that names no block, blocks whose repeated t or p
/// differ (the first such row or column is named, and which block has what). `names`, if given, are what
/// errors call the blocks; else they are called by their numbers.
Result<Block> stencil(std::span<const BlockPtr> blocks, const StencilMap& map,
                      std::span<const std::string> names = {});

/// An error where a stencil of this size would be too large a cloth, told from one of its blocks, since all
/// have to agree in their counts.
Status check_stencil_size(const BlockGrid& block, std::size_t rows, std::size_t columns);

/// What stencil() refuses of blocks for their counts, told from their grids alone. Of one grid it tells whether the cloth
/// would be too large.
Status check_stencil_counts(std::span<const BlockGrid* const> grids, std::size_t rows, std::size_t columns,
                            std::span<const std::string> names = {});

/// Changes the insertion order of the picks of one row: the k-th pick becomes the one that was number
/// order[k] of that row, from 0. Permutes rows of the card image within the row of the block and changes
/// nothing else.
Result<Block> renumber_row(const Block& block, std::size_t row, std::span<const std::size_t> order);

/// The same for the ends of one column.
Result<Block> renumber_column(const Block& block, std::size_t column, std::span<const std::size_t> order);

}  // namespace weave
