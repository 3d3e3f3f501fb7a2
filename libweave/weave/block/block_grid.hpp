#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace weave {

/// The rows and columns of a block: row i holds t[i] picks, column j holds p[j] ends.
class BlockGrid {
  public:
    BlockGrid() = default;
    BlockGrid(std::vector<std::uint32_t> t, std::vector<std::uint32_t> p)
        : m_t(std::move(t)),
          m_p(std::move(p)),
          m_first_pick(running_sums(m_t)),
          m_first_end(running_sums(m_p)) {}

    [[nodiscard]] std::size_t rows() const { return m_t.size(); }
    [[nodiscard]] std::size_t columns() const { return m_p.size(); }
    [[nodiscard]] std::size_t picks() const { return m_first_pick.back(); }
    [[nodiscard]] std::size_t ends() const { return m_first_end.back(); }
    /// Picks of each row.
    [[nodiscard]] const std::vector<std::uint32_t>& t() const { return m_t; }
    /// Ends of each column.
    [[nodiscard]] const std::vector<std::uint32_t>& p() const { return m_p; }

    /// Number of the first pick of a row, from 0; also defined for rows() as the total.
    [[nodiscard]] std::size_t first_pick(std::size_t row) const { return m_first_pick[row]; }
    [[nodiscard]] std::size_t first_end(std::size_t column) const { return m_first_end[column]; }
    [[nodiscard]] std::size_t row_of_pick(std::size_t pick) const { return line_of(pick, m_first_pick); }
    [[nodiscard]] std::size_t column_of_end(std::size_t end) const { return line_of(end, m_first_end); }
    /// Whether there is such a crossing; both from 0.
    [[nodiscard]] bool holds(std::size_t pick, std::size_t end) const {
        return pick < picks() && end < ends();
    }
    /// The cell of a crossing that there is, counted row by row.
    [[nodiscard]] std::size_t cell_of(std::size_t pick, std::size_t end) const {
        return row_of_pick(pick) * columns() + column_of_end(end);
    }

    friend bool operator==(const BlockGrid& a, const BlockGrid& b) {
        return a.m_t == b.m_t && a.m_p == b.m_p;
    }

  private:
    static std::vector<std::size_t> running_sums(const std::vector<std::uint32_t>& counts) {
        std::vector<std::size_t> sums{0};
        sums.reserve(counts.size() + 1);
        for (const std::uint32_t count : counts) sums.push_back(sums.back() + count);
        return sums;
    }
    static std::size_t line_of(std::size_t yarn, const std::vector<std::size_t>& firsts) {
        return static_cast<std::size_t>(std::upper_bound(firsts.begin(), firsts.end(), yarn) -
                                        firsts.begin()) -
               1;
    }

    std::vector<std::uint32_t> m_t, m_p;
    std::vector<std::size_t> m_first_pick{0}, m_first_end{0};
};

/// The counts of a block's lines `times` over, each `factor` times as large: a block repeated along them and
/// in height.
inline std::vector<std::uint32_t> repeated(const std::vector<std::uint32_t>& counts, std::size_t times,
                                           std::size_t factor) {
    std::vector<std::uint32_t> result;
    result.reserve(counts.size() * times);
    for (std::size_t k = 0; k < times; ++k) {
        for (const std::uint32_t count : counts) result.push_back(static_cast<std::uint32_t>(count * factor));
    }
    return result;
}

}  // namespace weave
