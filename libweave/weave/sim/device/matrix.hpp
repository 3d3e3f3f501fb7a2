#pragma once

#include <weave/sim/device/crew.hpp>
#include <weave/sim/device/view.hpp>

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace weave::sim {

/// A symmetric sparse matrix of 3×3 blocks, both halves stored, rows one after the other; see BlockMatrix.
struct MatrixView {
    std::uint32_t rows = 0;
    View<std::uint32_t> first;     ///< per row, and one more
    View<std::uint32_t> column;    ///< of each block; those of a row rise
    View<std::uint32_t> diagonal;  ///< per row: the block on the diagonal
    View<float> value;             ///< 9 a block, column by column
};

/// The first place from `begin` on, before `end`, that holds no less than `least` in numbers that rise; `end` if none does.
WEAVE_HD inline std::uint32_t first_from(const View<std::uint32_t>& rising, std::uint32_t begin, std::uint32_t end,
                                         std::uint32_t least) {
    while (begin < end) {
        const std::uint32_t middle = begin + (end - begin) / 2;
        if (rising[middle] < least) begin = middle + 1;
        else end = middle;
    }
    return begin;
}

/// Where the block of a row and column lies; it must be part of the shape.
WEAVE_HD inline std::uint32_t find_block(const MatrixView& matrix, std::uint32_t row, std::uint32_t column) {
    return first_from(matrix.column, matrix.first[row], matrix.first[row + 1], column);
}

/// Writes a block and what it is on the other side of the diagonal. On the diagonal what is not symmetric is rounding, and left.
/// `adds`: to what is there.
template <class Number>
WEAVE_HD inline void put_both(const MatrixView& matrix, std::uint32_t row, std::uint32_t at, Number (&block)[9], bool adds) {
    const std::uint32_t column = matrix.column[at];
    if (column == row) {
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < i; ++j) block[3 * j + i] = block[3 * i + j] = (block[3 * j + i] + block[3 * i + j]) / 2;
        }
    }
    float* to = matrix.value.at(9 * std::size_t(at), 9);
    for (int k = 0; k < 9; ++k) to[k] = static_cast<float>(block[k]) + (adds ? to[k] : 0.0F);
    if (column == row) return;
    float* mirrored = matrix.value.at(9 * std::size_t(find_block(matrix, column, row)), 9);
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) mirrored[3 * j + i] = to[3 * i + j];
    }
}

/// One number of A·x.
template <class Real>
struct MultiplyRow {
    MatrixView matrix;
    View<const Real> x;
    View<Real> result;

    WEAVE_HD void operator()(std::size_t i) const {
        const std::size_t row = i / 3, k = i - 3 * row;
        Real sum = 0;
        for (std::uint32_t at = matrix.first[row], end = matrix.first[row + 1]; at < end; ++at) {
            const float* a = matrix.value.at(9 * std::size_t(at), 9);
            const Real* of = x.at(3 * std::size_t(matrix.column[at]), 3);
            sum += Real(a[k]) * of[0] + Real(a[k + 3]) * of[1] + Real(a[k + 6]) * of[2];
        }
        result[i] = sum;
    }
};

/// result = A·x, 3 numbers a row. One barrier.
template <class Crew, class Real>
WEAVE_HD void multiply(Crew& crew, const MatrixView& matrix, std::type_identity_t<View<const Real>> x, View<Real> result) {
    crew.each(3 * std::size_t(matrix.rows), MultiplyRow<Real>{matrix, x, result});
}

/// See add_to_pivots().
struct AddToPivot {
    MatrixView matrix;
    float share;

    WEAVE_HD void operator()(std::size_t row) const {
        float* pivot = matrix.value.at(9 * std::size_t(matrix.diagonal[row]), 9);
        float sum = 0;
        for (int k = 0; k < 9; k += 4) sum += pivot[k] < 0 ? -pivot[k] : pivot[k];
        const float mean = sum / 3;
        for (int k = 0; k < 9; k += 4) pivot[k] += share * (mean > 1e-12F ? mean : 1e-12F);
    }
};

/// Adds a share of the mean of each pivot's diagonal to it. One barrier.
template <class Crew>
WEAVE_HD void add_to_pivots(Crew& crew, const MatrixView& matrix, float share) {
    crew.each(matrix.rows, AddToPivot{matrix, share});
}

}  // namespace weave::sim
