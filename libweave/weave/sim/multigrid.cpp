#include <weave/sim/multigrid.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace weave::sim {

namespace {

/// A piece spans so many pieces of the level before.
constexpr std::uint32_t span = 4;
/// So few rows are solved as a whole.
constexpr std::size_t last_rows = 128;
constexpr std::size_t rows_at_once = 64;
/// Pieces of this level hand on to the grids: the shortest, for yarns that cross move alike only close to where they do.
constexpr std::size_t grids_from = 1;
constexpr double pieces_per_node = 6;

std::uint32_t pieces_of(std::uint32_t rows) {
    return rows <= span ? 1 : (rows + span / 2) / span;
}

}  // namespace

template <class Real>
std::vector<YarnRows> rows_of_yarns(const Fabric<Real>& fabric) {
    std::vector<YarnRows> all;
    std::uint32_t row = 0;
    for (std::size_t y = 0; y < fabric.yarns().size(); ++y) {
        const YarnPlace& yarn = fabric.yarns()[y];
        YarnRows mine{row, 0, false};
        for (std::uint32_t i = 0; i < yarn.points; ++i) mine.rows += fabric.moves()[yarn.first_slot + 1 + i];
        mine.is_closed = fabric.scene().yarns[y].is_periodic && mine.rows == yarn.points;
        row += mine.rows;
        if (mine.rows > 0) all.push_back(mine);
    }
    return all;
}

template std::vector<YarnRows> rows_of_yarns(const Fabric<float>&);
template std::vector<YarnRows> rows_of_yarns(const Fabric<double>&);

template <class Real>
RowPlaces places_of(const Fabric<Real>& fabric) {
    RowPlaces places;
    const std::vector<Real> state = fabric.state();
    for (std::size_t slot = 0; slot < fabric.slots(); ++slot) {
        if (fabric.moves()[slot] != 0)
            places.at.push_back({static_cast<double>(state[3 * slot]), static_cast<double>(state[3 * slot + 1])});
    }
    for (std::size_t k = 0; k < 2; ++k)
        places.period[k] = fabric.scene().is_periodic[k] ? fabric.scene().period_mm[k] : 0;
    return places;
}

template RowPlaces places_of(const Fabric<float>&);
template RowPlaces places_of(const Fabric<double>&);

Multigrid::Multigrid(const Executor& executor, std::vector<YarnRows> yarns, RowPlaces places) : m_executor(executor) {
    std::size_t rows = 0;
    for (const YarnRows& yarn : yarns) rows += yarn.rows;
    m_levels.emplace_back().rows = rows;
    while (m_levels.back().rows > last_rows) {
        // Yarns that are one piece each are bundled with those beside them.
        if (m_levels.back().rows == yarns.size())
            yarns = {{0, static_cast<std::uint32_t>(yarns.size()), false}};
        add_pieces_of_yarns(m_levels.size() - 1, yarns);
    }
    if (places.at.size() != rows || m_levels.size() <= grids_from) return;
    for (std::size_t l = 1; l <= grids_from; ++l) places = places_of_pieces(m_levels[l], places);
    add_grids(grids_from, std::move(places));
}

/// Groups the rows of a level into pieces; `yarns` become those of the pieces.
void Multigrid::add_pieces_of_yarns(std::size_t finer, std::vector<YarnRows>& yarns) {
    std::vector<Shares> all;
    std::uint32_t pieces = 0;
    for (YarnRows& yarn : yarns) {
        const std::uint32_t count = pieces_of(yarn.rows);
        for (std::uint32_t i = 0; i < yarn.rows; ++i) {
            Shares shares{{pieces}, {1}};
            if (count > 1) {
                const double at = yarn.is_closed ? double(i) * count / yarn.rows
                                                   : double(i) * (count - 1) / (yarn.rows - 1);
                const auto piece = static_cast<std::uint32_t>(at);
                const std::uint32_t next = piece + 1 < count ? piece + 1 : yarn.is_closed ? 0 : piece;
                shares = {{pieces + piece, pieces + next}, {1 - (at - piece), at - piece}};
            }
            all.push_back(shares);
        }
        yarn = {pieces, count, yarn.is_closed};
        pieces += count;
    }
    add_level(finer, std::move(all), pieces);
}

void Multigrid::add_level(std::size_t finer, std::vector<Shares> shares, std::size_t pieces) {
    m_levels[finer].coarser.push_back(m_levels.size());
    Level& level = m_levels.emplace_back();
    level.rows = pieces;
    level.shares = std::move(shares);
    level.first_member.assign(pieces + 1, 0);
    const auto each_share = [&](const auto& visit) {
        for (std::uint32_t row = 0; row < level.shares.size(); ++row) {
            for (std::size_t k = 0; k < 4; ++k) {
                if (level.shares[row].weight[k] != 0) visit(row, level.shares[row].of[k], level.shares[row].weight[k]);
            }
        }
    };
    each_share([&](std::uint32_t, std::uint32_t piece, double) { ++level.first_member[piece + 1]; });
    for (std::size_t piece = 0; piece < pieces; ++piece)
        level.first_member[piece + 1] += level.first_member[piece];
    level.members.resize(level.first_member.back());
    level.member_weight.resize(level.members.size());
    std::vector<std::uint32_t> next(level.first_member.begin(), level.first_member.end() - 1);
    each_share([&](std::uint32_t row, std::uint32_t piece, double weight) {
        level.member_weight[next[piece]] = weight;
        level.members[next[piece]++] = row;
    });
}

/// A piece lies where the row lies that belongs to it most.
RowPlaces Multigrid::places_of_pieces(const Level& pieces, const RowPlaces& places) {
    RowPlaces of{std::vector<std::array<double, 2>>(pieces.rows), places.period};
    std::vector<double> most(pieces.rows, 0);
    for (std::size_t row = 0; row < pieces.shares.size(); ++row) {
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint32_t piece = pieces.shares[row].of[k];
            if (pieces.shares[row].weight[k] <= most[piece]) continue;
            most[piece] = pieces.shares[row].weight[k];
            of.at[piece] = places.at[row];
        }
    }
    return of;
}

/// From a node for every few pieces on, each grid twice as wide as the one before.
void Multigrid::add_grids(std::size_t finer, RowPlaces places) {
    std::array<double, 2> size{1e-9, 1e-9};
    for (std::size_t k = 0; k < 2; ++k) {
        for (const std::array<double, 2>& at : places.at) size[k] = std::max(size[k], at[k] - places.at[0][k]);
    }
    double spacing = std::sqrt(pieces_per_node * size[0] * size[1] / static_cast<double>(places.at.size()));
    while (m_levels[finer].rows > last_rows && add_grid(finer, spacing, places)) {
        finer = m_levels.size() - 1;
        spacing *= 2;
    }
}

/// Each row belongs to the four nodes around it; `places` become those of the nodes. False if they are not fewer.
bool Multigrid::add_grid(std::size_t finer, double spacing, RowPlaces& places) {
    std::array<double, 2> low{1e300, 1e300}, step{};
    std::array<std::int64_t, 2> around{};  // nodes to the period
    for (std::size_t k = 0; k < 2; ++k) {
        for (const std::array<double, 2>& at : places.at) low[k] = std::min(low[k], at[k]);
        around[k] = places.period[k] > 0 ? std::max<std::int64_t>(1, std::llround(places.period[k] / spacing)) : 0;
        step[k] = around[k] > 0 ? places.period[k] / static_cast<double>(around[k]) : spacing;
    }
    std::map<std::array<std::int64_t, 2>, std::uint32_t> numbers;
    std::vector<std::array<double, 2>> nodes;
    std::vector<Shares> all;
    for (const std::array<double, 2>& at : places.at) {
        const double x = (at[0] - low[0]) / step[0], y = (at[1] - low[1]) / step[1], i = std::floor(x), j = std::floor(y);
        Shares shares;
        for (std::size_t k = 0; k < 4; ++k) {
            const auto right = static_cast<double>(k % 2), up = static_cast<double>(k / 2);
            std::array<std::int64_t, 2> node{std::llround(i + right), std::llround(j + up)};
            for (std::size_t axis = 0; axis < 2; ++axis) {
                if (around[axis] > 0) node[axis] = ((node[axis] % around[axis]) + around[axis]) % around[axis];
            }
            const double weight = (k % 2 == 0 ? 1 - (x - i) : x - i) * (k / 2 == 0 ? 1 - (y - j) : y - j);
            if (weight == 0) {
                shares.weight[k] = 0;
                continue;
            }
            const auto [found, is_new] = numbers.try_emplace(node, static_cast<std::uint32_t>(nodes.size()));
            if (is_new)
                nodes.push_back({low[0] + static_cast<double>(node[0]) * step[0],
                                 low[1] + static_cast<double>(node[1]) * step[1]});
            // On a small torus the same node may lie on two sides.
            std::size_t to = 0;
            while (to < k && !(shares.of[to] == found->second && shares.weight[to] != 0)) ++to;
            if (to == k) shares.weight[k] = 0;
            shares.of[to] = found->second;
            shares.weight[to] += weight;
        }
        all.push_back(shares);
    }
    if (nodes.size() >= places.at.size()) return false;
    places.at = std::move(nodes);
    add_level(finer, std::move(all), places.at.size());
    return true;
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
    factor(0, matrix);
}

void Multigrid::factor(std::size_t number, const BlockMatrix& matrix) {
    if (m_levels[number].coarser.empty()) return factor_whole(matrix, m_levels[number]);
    invert_pivots(matrix, m_levels[number]);
    for (const std::size_t next : m_levels[number].coarser) {
        coarsen(matrix, m_levels[next], m_levels[next].matrix);
        factor(next, m_levels[next].matrix);
    }
}

namespace {

/// No direction of a pivot counts as softer than this share of its stiffest.
constexpr double softest = 1e-4;

/// The inverse of a pivot. One that is not positive is made so: a direction that curves down counts as one that curves
/// up as much.
Eigen::Matrix3d inverse_of(const Eigen::Matrix3d& pivot) {
    const double trace = pivot.trace(), minor = pivot(0, 0) * pivot(1, 1) - pivot(0, 1) * pivot(0, 1),
                 volume = pivot.determinant();
    // All three directions are positive, and the softest is no less than 4·volume / trace².
    if (pivot(0, 0) > 0 && minor > 0 && 4 * volume > softest * trace * trace * trace) return pivot.inverse();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    eigen.computeDirect(pivot);
    const Eigen::Vector3d sizes = eigen.eigenvalues().cwiseAbs();
    const double least = softest * std::max(sizes.maxCoeff(), 1e-30);
    const Eigen::Matrix3d& axes = eigen.eigenvectors();
    return axes * sizes.cwiseMax(least).cwiseInverse().asDiagonal() * axes.transpose();
}

}  // namespace

void Multigrid::invert_pivots(const BlockMatrix& matrix, Level& level) const {
    level.inverse.resize(9 * level.rows);
    each_row(level.rows, [&](std::size_t row) {
        const Eigen::Matrix3d pivot =
            Eigen::Map<const BlockMatrix::Block>(matrix.value(matrix.diagonal(row))).cast<double>();
        Eigen::Map<Eigen::Matrix3d>(&level.inverse[9 * row]) = inverse_of((pivot + pivot.transpose()) / 2);
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
void Multigrid::coarsen(const BlockMatrix& fine, const Level& level, BlockMatrix& coarse) const {
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

void Multigrid::restrict_to(Level& level, const std::vector<double>& fine) const {
    level.residual.resize(3 * level.rows);
    each_row(level.rows, [&](std::size_t piece) {
        double sum[3]{};
        for (std::uint32_t m = level.first_member[piece]; m < level.first_member[piece + 1]; ++m) {
            const double* of = &fine[3 * std::size_t(level.members[m])];
            const double weight = level.member_weight[m];
            for (std::size_t k = 0; k < 3; ++k) sum[k] += weight * of[k];
        }
        for (std::size_t k = 0; k < 3; ++k) level.residual[3 * piece + k] = sum[k];
    });
}

void Multigrid::add_pieces(const Level& level, std::vector<double>& fine) const {
    each_row(level.shares.size(), [&](std::size_t row) {
        const Shares& shares = level.shares[row];
        double sum[3]{fine[3 * row], fine[3 * row + 1], fine[3 * row + 2]};
        for (std::size_t s = 0; s < 4; ++s) {
            if (shares.weight[s] == 0) continue;
            const double* of = &level.step[3 * std::size_t(shares.of[s])];
            for (std::size_t k = 0; k < 3; ++k) sum[k] += shares.weight[s] * of[k];
        }
        for (std::size_t k = 0; k < 3; ++k) fine[3 * row + k] = sum[k];
    });
}

void Multigrid::solve(std::size_t number, const std::vector<double>& residual, std::vector<double>& step) {
    Level& level = m_levels[number];
    step.resize(residual.size());
    if (level.coarser.empty()) {
        const auto size = static_cast<Eigen::Index>(residual.size());
        Eigen::Map<Eigen::VectorXd>(step.data(), size) =
            level.whole.solve(Eigen::Map<const Eigen::VectorXd>(residual.data(), size));
        return;
    }
    each_row(level.rows, [&](std::size_t row) {
        const double *a = &level.inverse[9 * row], *of = &residual[3 * row];
        for (std::size_t k = 0; k < 3; ++k)
            step[3 * row + k] = a[k] * of[0] + a[k + 3] * of[1] + a[k + 6] * of[2];
    });
    for (const std::size_t number_of_next : level.coarser) {
        Level& next = m_levels[number_of_next];
        restrict_to(next, residual);
        solve(number_of_next, next.residual, next.step);
        add_pieces(next, step);
    }
}

void Multigrid::apply(const std::vector<double>& residual, std::vector<double>& step) {
    solve(0, residual, step);
}

}  // namespace weave::sim
