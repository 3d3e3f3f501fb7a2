#pragma once

#include <weave/sim/execute.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace weave::sim {

/// A symmetric sparse matrix of 3×3 blocks, both halves stored. Entries are float: they only shape steps, whose goal is
/// judged in double, and half the bytes are twice the speed.
class BlockMatrix {
  public:
    using Block = Eigen::Matrix<float, 3, 3>;

    /// `first` has one entry more than there are rows; the columns of a row rise.
    void shape(std::vector<std::uint32_t> first, std::vector<std::uint32_t> columns);
    void clear_values();

    [[nodiscard]] std::size_t rows() const { return m_first.empty() ? 0 : m_first.size() - 1; }
    [[nodiscard]] std::size_t blocks() const { return m_columns.size(); }
    [[nodiscard]] std::uint32_t first(std::size_t row) const { return m_first[row]; }
    [[nodiscard]] std::uint32_t column(std::size_t at) const { return m_columns[at]; }
    [[nodiscard]] float* value(std::size_t at) { return &m_values[9 * at]; }
    [[nodiscard]] const float* value(std::size_t at) const { return &m_values[9 * at]; }
    [[nodiscard]] std::uint32_t diagonal(std::size_t row) const { return m_diagonal[row]; }
    /// Adds a share of the mean of each pivot's diagonal to it.
    void add_to_pivots(float share);
    /// Where the block of a row and column lies; it must be part of the shape.
    [[nodiscard]] std::size_t find(std::uint32_t row, std::uint32_t column) const {
        const auto begin = m_columns.begin();
        return static_cast<std::size_t>(std::lower_bound(begin + m_first[row], begin + m_first[row + 1], column) - begin);
    }
    [[nodiscard]] std::size_t bytes() const { return m_values.capacity() * 4 + m_columns.capacity() * 4 + m_first.capacity() * 8; }

    /// result = A·x, 3 numbers a row.
    void multiply(const Executor& executor, const std::vector<double>& x, std::vector<double>& result) const;

  private:
    std::vector<std::uint32_t> m_first, m_columns, m_diagonal;
    std::vector<float> m_values;  ///< 9 a block, column by column
};

/// A·x ≈ b made easy: a positive definite matrix near A whose inverse is cheap.
class Preconditioner {
  public:
    virtual ~Preconditioner() = default;
    virtual void apply(const std::vector<double>& residual, std::vector<double>& step) = 0;
};

}  // namespace weave::sim
