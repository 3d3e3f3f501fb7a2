#include <weave/sim/multigrid.hpp>

#include <weave/sim/pivots.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace weave::sim {

namespace {

constexpr std::size_t rows_at_once = 64;

}  // namespace

Multigrid::Multigrid(const Executor& executor, std::vector<YarnRows> yarns, RowPlaces places)
    : m_executor(executor), m_hierarchy(std::move(yarns), std::move(places)), m_levels(m_hierarchy.levels().size()) {}

/// Few rows are not worth waking a thread for.
template <class Body>
void Multigrid::each_row(std::size_t rows, const Body& body) const {
    m_executor.each((rows + rows_at_once - 1) / rows_at_once, [&](std::size_t part) {
        for (std::size_t row = part * rows_at_once; row < std::min(rows, (part + 1) * rows_at_once); ++row)
            body(row);
    });
}

void Multigrid::factor(const BlockMatrix& matrix) {
    factor(0, matrix);
}

void Multigrid::factor(std::size_t number, const BlockMatrix& matrix) {
    const PieceLevel& level = m_hierarchy.levels()[number];
    if (level.coarser.empty()) return factor_whole(matrix, m_levels[number]);
    invert_pivots(matrix, m_levels[number].inverse);
    for (const std::size_t next : level.coarser) {
        coarsen(matrix, m_hierarchy.levels()[next], m_levels[next].matrix);
        factor(next, m_levels[next].matrix);
    }
}

void Multigrid::invert_pivots(const BlockMatrix& matrix, std::vector<double>& inverse) const {
    inverse.resize(9 * matrix.rows());
    each_row(matrix.rows(), [&](std::size_t row) {
        const Eigen::Matrix3d pivot =
            Eigen::Map<const BlockMatrix::Block>(matrix.value(matrix.diagonal(row))).cast<double>();
        Eigen::Map<Eigen::Matrix3d>(inverse.data() + 9 * row) = inverse_of_pivot((pivot + pivot.transpose()) / 2);
    });
}

namespace {

/// Rows of a coarse matrix as one thread makes them.
struct CoarseRows {
    std::vector<std::uint32_t> columns, count;
    std::vector<float> values;

    std::vector<std::uint32_t>
        place;  ///< per column: where its sum lies in this row, 0 if nowhere yet, else plus one
    std::vector<std::uint32_t> found, sorted;
    std::vector<double> sums;  ///< 9 each

    /// Where the sum of a column lies.
    [[gnu::always_inline]] double* sum_of(std::uint32_t column) {
        if (place[column] == 0) {
            found.push_back(column);
            sums.resize(sums.size() + 9, 0.0);
            place[column] = static_cast<std::uint32_t>(found.size());
        }
        return &sums[9 * (place[column] - std::size_t{1})];
    }

    void end_row() {
        sorted = found;
        std::sort(sorted.begin(), sorted.end());
        for (const std::uint32_t column : sorted) {
            const double* sum = sum_of(column);
            for (int k = 0; k < 9; ++k) values.push_back(static_cast<float>(sum[k]));
        }
        for (const std::uint32_t column : found) place[column] = 0;
        columns.insert(columns.end(), sorted.begin(), sorted.end());
        count.push_back(static_cast<std::uint32_t>(sorted.size()));
        found.clear();
        sums.clear();
    }
};

/// Adds one row of the fine matrix to that of a piece, from its pivot on.
template <class Shares>
WEAVE_WIDE void add_row(const BlockMatrix& fine, std::size_t row, double weight, const Shares* shares, std::size_t piece,
                        CoarseRows& to) {
    for (std::uint32_t at = fine.first(row); at < fine.first(row + 1); ++at) {
        const float* block = fine.value(at);
        double whole[9];
        float size = 0;
        for (int k = 0; k < 9; ++k) {
            whole[k] = weight * double(block[k]);
            size += std::abs(block[k]);
        }
        if (size == 0) continue;  // near, but not touching
        const Shares& theirs = shares[fine.column(at)];
        for (std::size_t s = 0; s < 4; ++s) {
            const double share = theirs.weight[s];
            if (share == 0 || theirs.of[s] < piece) continue;
            double* sum = to.sum_of(theirs.of[s]);
            for (int k = 0; k < 9; ++k) sum[k] += share * whole[k];
        }
    }
}

/// A matrix from the upper half of its rows. What lies left of a pivot comes from the rows before, in their order.
void mirror(const std::vector<CoarseRows>& upper, std::size_t pieces, BlockMatrix& matrix) {
    std::vector<std::uint32_t> first(pieces + 1, 0);
    const auto each_block = [&](const auto& visit) {
        std::uint32_t row = 0;
        for (const CoarseRows& rows : upper) {
            std::size_t at = 0;
            for (const std::uint32_t count : rows.count) {
                for (const std::size_t end = at + count; at < end; ++at) visit(row, rows.columns[at], &rows.values[9 * at]);
                ++row;
            }
        }
    };
    each_block([&](std::uint32_t row, std::uint32_t column, const float*) {
        ++first[row + 1];
        if (column != row) ++first[column + 1];
    });
    for (std::size_t row = 0; row < pieces; ++row) first[row + 1] += first[row];
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1), columns(first.back());
    each_block([&](std::uint32_t row, std::uint32_t column, const float*) {
        columns[next[row]++] = column;
        if (column != row) columns[next[column]++] = row;
    });
    next.assign(first.begin(), first.end() - 1);
    matrix.shape(std::move(first), std::move(columns));
    each_block([&](std::uint32_t row, std::uint32_t column, const float* from) {
        std::copy(from, from + 9, matrix.value(next[row]++));
        if (column == row) return;
        float* to = matrix.value(next[column]++);
        for (int k = 0; k < 9; ++k) to[k] = from[3 * (k % 3) + k / 3];
    });
}

}  // namespace

/// PᵀAP, P being the shares.
void Multigrid::coarsen(const BlockMatrix& fine, const PieceLevel& level, BlockMatrix& coarse) const {
    const std::size_t pieces = level.first_member.size() - 1, parts = std::min<std::size_t>(64, pieces);
    std::vector<CoarseRows> made(parts);
    m_executor.each(parts, [&](std::size_t part) {
        CoarseRows& rows = made[part];
        rows.place.assign(pieces, 0);
        for (std::size_t piece = pieces * part / parts; piece < pieces * (part + 1) / parts; ++piece) {
            for (std::uint32_t m = level.first_member[piece]; m < level.first_member[piece + 1]; ++m) {
                add_row(fine, level.members[m], level.member_weight[m], level.shares.data(), piece, rows);
            }
            rows.sum_of(static_cast<std::uint32_t>(piece));  // it has a pivot whatever it holds
            rows.end_row();
        }
        rows.place = {};
    });
    mirror(made, pieces, coarse);
}

/// Whatever the matrix, some damping makes it positive.
void Multigrid::factor_whole(const BlockMatrix& matrix, Level& level) {
    const auto size = static_cast<Eigen::Index>(3 * matrix.rows());
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(size, size);
    for (std::size_t row = 0; row < matrix.rows(); ++row) {
        for (std::uint32_t at = matrix.first(row); at < matrix.first(row + 1); ++at)
            whole.block<3, 3>(static_cast<Eigen::Index>(3 * row),
                              3 * static_cast<Eigen::Index>(matrix.column(at))) =
                Eigen::Map<const BlockMatrix::Block>(matrix.value(at)).cast<double>();
    }
    const double mean = std::max(1e-30, size > 0 ? whole.diagonal().cwiseAbs().mean() : 0);
    double damping = 1e-6 * mean;
    do {
        whole.diagonal().array() += damping;
        level.whole.compute(whole);
        damping *= 8;
    } while (level.whole.info() != Eigen::Success && damping < 1e6 * mean);
}

void Multigrid::restrict_to(std::size_t number, const std::vector<double>& fine) {
    const PieceLevel& level = m_hierarchy.levels()[number];
    std::vector<double>& residual = m_levels[number].residual;
    residual.resize(3 * level.rows);
    each_row(level.rows, [&](std::size_t piece) {
        double sum[3]{};
        for (std::uint32_t m = level.first_member[piece]; m < level.first_member[piece + 1]; ++m) {
            const double* of = &fine[3 * std::size_t(level.members[m])];
            const double weight = level.member_weight[m];
            for (std::size_t k = 0; k < 3; ++k) sum[k] += weight * of[k];
        }
        for (std::size_t k = 0; k < 3; ++k) residual[3 * piece + k] = sum[k];
    });
}

void Multigrid::add_pieces(std::size_t number, std::vector<double>& fine) const {
    const PieceLevel& level = m_hierarchy.levels()[number];
    const std::vector<double>& step = m_levels[number].step;
    each_row(level.shares.size(), [&](std::size_t row) {
        const PieceShares& shares = level.shares[row];
        double sum[3]{fine[3 * row], fine[3 * row + 1], fine[3 * row + 2]};
        for (std::size_t s = 0; s < 4; ++s) {
            if (shares.weight[s] == 0) continue;
            const double* of = &step[3 * std::size_t(shares.of[s])];
            for (std::size_t k = 0; k < 3; ++k) sum[k] += shares.weight[s] * of[k];
        }
        for (std::size_t k = 0; k < 3; ++k) fine[3 * row + k] = sum[k];
    });
}

void Multigrid::solve(std::size_t number, const std::vector<double>& residual, std::vector<double>& step) {
    const PieceLevel& pieces = m_hierarchy.levels()[number];
    Level& level = m_levels[number];
    step.resize(residual.size());
    if (pieces.coarser.empty()) {
        const auto size = static_cast<Eigen::Index>(residual.size());
        Eigen::Map<Eigen::VectorXd>(step.data(), size) =
            level.whole.solve(Eigen::Map<const Eigen::VectorXd>(residual.data(), size));
        return;
    }
    each_row(pieces.rows, [&](std::size_t row) {
        const double *a = &level.inverse[9 * row], *of = &residual[3 * row];
        for (std::size_t k = 0; k < 3; ++k)
            step[3 * row + k] = a[k] * of[0] + a[k + 3] * of[1] + a[k + 6] * of[2];
    });
    for (const std::size_t next : pieces.coarser) {
        restrict_to(next, residual);
        solve(next, m_levels[next].residual, m_levels[next].step);
        add_pieces(next, step);
    }
}

void Multigrid::apply(const std::vector<double>& residual, std::vector<double>& step) {
    solve(0, residual, step);
}

}  // namespace weave::sim
