#include <weave/sim/multigrid.hpp>

#include <algorithm>
#include <cmath>

namespace weave::sim {

namespace {

/// A piece spans so many pieces of the level before.
constexpr std::uint32_t span = 4;
/// So few rows are solved as a whole.
constexpr std::size_t last_rows = 128;
constexpr std::size_t rows_at_once = 64;

std::uint32_t pieces_of(std::uint32_t rows) {
    return rows <= span ? 1 : (rows + span / 2) / span;
}

}  // namespace

template <class Real>
std::vector<Strand> strands_of(const Fabric<Real>& fabric) {
    std::vector<Strand> strands;
    std::uint32_t row = 0;
    for (std::size_t y = 0; y < fabric.yarns().size(); ++y) {
        const YarnPlace& yarn = fabric.yarns()[y];
        Strand strand{row, 0, false};
        for (std::uint32_t i = 0; i < yarn.points; ++i)
            strand.rows += fabric.moves()[yarn.first_slot + 1 + i];
        strand.is_closed = fabric.scene().yarns[y].is_periodic && strand.rows == yarn.points;
        row += strand.rows;
        if (strand.rows > 0) strands.push_back(strand);
    }
    return strands;
}

template std::vector<Strand> strands_of(const Fabric<float>&);
template std::vector<Strand> strands_of(const Fabric<double>&);

Multigrid::Multigrid(const Executor& executor, std::vector<Strand> strands) : m_executor(executor) {
    std::size_t rows = 0;
    for (const Strand& strand : strands) rows += strand.rows;
    m_levels.emplace_back().rows = rows;
    while (m_levels.back().rows > last_rows) {
        // Yarns that are one piece each are bundled with those beside them.
        if (m_levels.back().rows == strands.size())
            strands = {{0, static_cast<std::uint32_t>(strands.size()), false}};
        add_level(strands);
    }
}

/// Groups the rows of the last level into pieces; `strands` become those of the pieces.
void Multigrid::add_level(std::vector<Strand>& strands) {
    Level& level = m_levels.back();
    std::uint32_t pieces = 0;
    for (Strand& strand : strands) {
        const std::uint32_t count = pieces_of(strand.rows);
        for (std::uint32_t i = 0; i < strand.rows; ++i) {
            Shares shares{{pieces, pieces}, {1, 0}};
            if (count > 1) {
                const double at = strand.is_closed ? double(i) * count / strand.rows
                                                   : double(i) * (count - 1) / (strand.rows - 1);
                const auto piece = static_cast<std::uint32_t>(at);
                const std::uint32_t next = piece + 1 < count ? piece + 1 : strand.is_closed ? 0 : piece;
                shares = {{pieces + piece, pieces + next}, {1 - (at - piece), at - piece}};
            }
            level.shares.push_back(shares);
        }
        strand = {pieces, count, strand.is_closed};
        pieces += count;
    }
    list_members(level, pieces);
    m_levels.emplace_back().rows = pieces;
}

void Multigrid::list_members(Level& level, std::size_t pieces) const {
    level.first_member.assign(pieces + 1, 0);
    const auto each_share = [&](const auto& visit) {
        for (std::uint32_t row = 0; row < level.rows; ++row) {
            for (std::size_t k = 0; k < 2; ++k) {
                if (level.shares[row].weight[k] != 0) visit(row, level.shares[row].of[k]);
            }
        }
    };
    each_share([&](std::uint32_t, std::uint32_t piece) { ++level.first_member[piece + 1]; });
    for (std::size_t piece = 0; piece < pieces; ++piece)
        level.first_member[piece + 1] += level.first_member[piece];
    level.members.resize(level.first_member.back());
    std::vector<std::uint32_t> next(level.first_member.begin(), level.first_member.end() - 1);
    each_share([&](std::uint32_t row, std::uint32_t piece) { level.members[next[piece]++] = row; });
}

/// Few rows are not worth waking a thread for.
template <class Body>
void Multigrid::each_row(std::size_t rows, const Body& body) const {
    m_executor.each((rows + rows_at_once - 1) / rows_at_once, [&](std::size_t part) {
        for (std::size_t row = part * rows_at_once; row < std::min(rows, (part + 1) * rows_at_once); ++row)
            body(row);
    });
}

void Multigrid::factor(const BlockMatrix& matrix) {
    const BlockMatrix* fine = &matrix;
    for (std::size_t l = 0; l + 1 < m_levels.size(); ++l) {
        invert_pivots(*fine, m_levels[l]);
        coarsen(*fine, m_levels[l], m_levels[l + 1].matrix);
        fine = &m_levels[l + 1].matrix;
    }
    factor_last(*fine);
}

/// A pivot that is not positive is made so: a direction that curves down counts as one that curves up as
/// much.
void Multigrid::invert_pivots(const BlockMatrix& matrix, Level& level) const {
    level.inverse.resize(9 * level.rows);
    each_row(level.rows, [&](std::size_t row) {
        const Eigen::Matrix3d pivot =
            Eigen::Map<const BlockMatrix::Block>(matrix.value(matrix.diagonal(row))).cast<double>();
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
        eigen.computeDirect((pivot + pivot.transpose()) / 2);
        const Eigen::Vector3d sizes = eigen.eigenvalues().cwiseAbs();
        const double least = 1e-4 * std::max(sizes.maxCoeff(), 1e-30);
        const Eigen::Matrix3d& axes = eigen.eigenvectors();
        Eigen::Map<Eigen::Matrix3d>(&level.inverse[9 * row]) =
            axes * sizes.cwiseMax(least).cwiseInverse().asDiagonal() * axes.transpose();
    });
}

namespace {

/// Rows of a coarse matrix as one thread makes them.
struct CoarseRows {
    std::vector<std::uint32_t> columns, count;
    std::vector<float> values;

    std::vector<std::uint32_t>
        place;  ///< per column: where its sum lies in this row, 0 if nowhere yet, else plus one
    std::vector<std::uint32_t> found;
    std::vector<Eigen::Matrix3d> sums;

    void add(std::uint32_t column, double weight, const Eigen::Matrix3d& block) {
        if (place[column] == 0) {
            found.push_back(column);
            sums.emplace_back(Eigen::Matrix3d::Zero());
            place[column] = static_cast<std::uint32_t>(found.size());
        }
        sums[place[column] - 1] += weight * block;
    }

    void end_row() {
        std::vector<std::uint32_t> sorted = found;
        std::sort(sorted.begin(), sorted.end());
        for (const std::uint32_t column : sorted) {
            const Eigen::Matrix3f block = sums[place[column] - 1].cast<float>();
            values.insert(values.end(), block.data(), block.data() + 9);
            place[column] = 0;
        }
        columns.insert(columns.end(), sorted.begin(), sorted.end());
        count.push_back(static_cast<std::uint32_t>(sorted.size()));
        found.clear();
        sums.clear();
    }
};

}  // namespace

/// PᵀAP, P being the shares.
void Multigrid::coarsen(const BlockMatrix& fine, const Level& level, BlockMatrix& coarse) const {
    const std::size_t pieces = level.first_member.size() - 1, parts = std::min<std::size_t>(64, pieces);
    std::vector<CoarseRows> made(parts);
    m_executor.each(parts, [&](std::size_t part) {
        CoarseRows& rows = made[part];
        rows.place.assign(pieces, 0);
        for (std::size_t piece = pieces * part / parts; piece < pieces * (part + 1) / parts; ++piece) {
            for (std::uint32_t m = level.first_member[piece]; m < level.first_member[piece + 1]; ++m) {
                const std::uint32_t row = level.members[m];
                const Shares& mine = level.shares[row];
                const double weight = mine.of[0] == piece ? mine.weight[0] : mine.weight[1];
                for (std::uint32_t at = fine.first(row); at < fine.first(row + 1); ++at) {
                    const Shares& theirs = level.shares[fine.column(at)];
                    const Eigen::Matrix3d block =
                        Eigen::Map<const BlockMatrix::Block>(fine.value(at)).cast<double>();
                    for (std::size_t k = 0; k < 2; ++k) {
                        if (theirs.weight[k] != 0) rows.add(theirs.of[k], weight * theirs.weight[k], block);
                    }
                }
            }
            rows.end_row();
        }
        rows.place = {};
    });
    std::vector<std::uint32_t> first{0}, columns;
    for (const CoarseRows& rows : made) {
        for (const std::uint32_t count : rows.count) first.push_back(first.back() + count);
        columns.insert(columns.end(), rows.columns.begin(), rows.columns.end());
    }
    coarse.shape(std::move(first), std::move(columns));
    float* to = coarse.value(0);
    for (const CoarseRows& rows : made) to = std::copy(rows.values.begin(), rows.values.end(), to);
}

/// Whatever the matrix, some damping makes it positive.
void Multigrid::factor_last(const BlockMatrix& matrix) {
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
        m_last.compute(whole);
        damping *= 8;
    } while (m_last.info() != Eigen::Success && damping < 1e6 * mean);
}

void Multigrid::restrict_to(const Level& level, const std::vector<double>& fine,
                            std::vector<double>& coarse) const {
    const std::size_t pieces = level.first_member.size() - 1;
    coarse.resize(3 * pieces);
    each_row(pieces, [&](std::size_t piece) {
        double sum[3]{};
        for (std::uint32_t m = level.first_member[piece]; m < level.first_member[piece + 1]; ++m) {
            const std::size_t row = level.members[m];
            const Shares& shares = level.shares[row];
            const double weight = shares.of[0] == piece ? shares.weight[0] : shares.weight[1];
            for (std::size_t k = 0; k < 3; ++k) sum[k] += weight * fine[3 * row + k];
        }
        for (std::size_t k = 0; k < 3; ++k) coarse[3 * piece + k] = sum[k];
    });
}

void Multigrid::add_pieces(const Level& level, const std::vector<double>& coarse,
                           std::vector<double>& fine) const {
    each_row(level.rows, [&](std::size_t row) {
        const Shares& shares = level.shares[row];
        const double *one = &coarse[3 * std::size_t(shares.of[0])],
                     *other = &coarse[3 * std::size_t(shares.of[1])];
        for (std::size_t k = 0; k < 3; ++k)
            fine[3 * row + k] += shares.weight[0] * one[k] + shares.weight[1] * other[k];
    });
}

void Multigrid::solve(std::size_t number, const std::vector<double>& residual, std::vector<double>& step) {
    Level& level = m_levels[number];
    step.resize(residual.size());
    if (number + 1 == m_levels.size()) {
        const auto size = static_cast<Eigen::Index>(residual.size());
        Eigen::Map<Eigen::VectorXd>(step.data(), size) =
            m_last.solve(Eigen::Map<const Eigen::VectorXd>(residual.data(), size));
        return;
    }
    each_row(level.rows, [&](std::size_t row) {
        const double *a = &level.inverse[9 * row], *of = &residual[3 * row];
        for (std::size_t k = 0; k < 3; ++k)
            step[3 * row + k] = a[k] * of[0] + a[k + 3] * of[1] + a[k + 6] * of[2];
    });
    Level& next = m_levels[number + 1];
    restrict_to(level, residual, next.residual);
    solve(number + 1, next.residual, next.step);
    add_pieces(level, next.step, step);
}

void Multigrid::apply(const std::vector<double>& residual, std::vector<double>& step) {
    solve(0, residual, step);
}

}  // namespace weave::sim
