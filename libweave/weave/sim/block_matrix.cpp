#include <weave/sim/block_matrix.hpp>

#include <algorithm>
#include <cmath>

namespace weave::sim {

namespace {

/// Four numbers that are worked on at once.
typedef double Four __attribute__((vector_size(32), aligned(8), may_alias));
typedef float FourFloats __attribute__((vector_size(16), aligned(4), may_alias));

/// Each column of a block is three of four numbers that are read; the fourth belongs to what follows, and its sum is
/// left.
WEAVE_WIDE void multiply_rows(std::size_t first_row, std::size_t last_row, const std::uint32_t* first,
                              const std::uint32_t* columns, const float* values, const double* x, double* result) {
    for (std::size_t row = first_row; row < last_row; ++row) {
        Four sums[3]{};
        for (std::uint32_t at = first[row]; at < first[row + 1]; ++at) {
            const float* a = values + 9 * std::size_t(at);
            const double* of = x + 3 * std::size_t(columns[at]);
            for (int k = 0; k < 3; ++k)
                sums[k] += __builtin_convertvector(*reinterpret_cast<const FourFloats*>(a + 3 * k), Four) * of[k];
        }
        const Four sum = sums[0] + sums[1] + sums[2];
        for (std::size_t k = 0; k < 3; ++k) result[3 * row + k] = sum[k];
    }
}

}  // namespace

void BlockMatrix::shape(std::vector<std::uint32_t> first, std::vector<std::uint32_t> columns) {
    m_first = std::move(first);
    m_columns = std::move(columns);
    m_values.assign(9 * m_columns.size() + 1, 0);  // multiply() reads one number more
    m_diagonal.resize(rows());
    for (std::uint32_t row = 0; row < rows(); ++row) m_diagonal[row] = static_cast<std::uint32_t>(find(row, row));
}

void BlockMatrix::clear_values() {
    std::fill(m_values.begin(), m_values.end(), 0.0F);
}

void BlockMatrix::add_to_pivots(float share) {
    for (std::size_t row = 0; row < rows(); ++row) {
        float* pivot = value(diagonal(row));
        const float mean = (std::abs(pivot[0]) + std::abs(pivot[4]) + std::abs(pivot[8])) / 3;
        for (int k = 0; k < 9; k += 4) pivot[k] += share * std::max(1e-12F, mean);
    }
}

void BlockMatrix::multiply(const Executor& executor, const std::vector<double>& x, std::vector<double>& result) const {
    result.resize(3 * rows());
    executor.ranges(rows(), [&](std::size_t begin, std::size_t end) {
        multiply_rows(begin, end, m_first.data(), m_columns.data(), m_values.data(), x.data(), result.data());
    });
}

}  // namespace weave::sim
