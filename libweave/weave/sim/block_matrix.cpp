#include <weave/sim/block_matrix.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace weave::sim {

namespace {

using ConstBlock = Eigen::Map<const BlockMatrix::Block>;

Eigen::Map<BlockMatrix::Block> block_of(std::vector<float>& values, std::size_t at) {
    return Eigen::Map<BlockMatrix::Block>(values.data() + 9 * at);
}

double dot(const Executor& executor, const std::vector<double>& a, const std::vector<double>& b) {
    return executor.sum(a.size(), [&](std::size_t i) { return a[i] * b[i]; });
}

}  // namespace

void BlockMatrix::shape(std::vector<std::uint32_t> first, std::vector<std::uint32_t> columns) {
    m_first = std::move(first);
    m_columns = std::move(columns);
    m_values.assign(9 * m_columns.size(), 0);
    m_diagonal.resize(rows());
    for (std::uint32_t row = 0; row < rows(); ++row) m_diagonal[row] = static_cast<std::uint32_t>(find(row, row));
}

void BlockMatrix::clear_values() {
    std::fill(m_values.begin(), m_values.end(), 0.0F);
}

std::size_t BlockMatrix::find(std::uint32_t row, std::uint32_t column) const {
    const auto begin = m_columns.begin();
    const auto at = std::lower_bound(begin + m_first[row], begin + m_first[row + 1], column);
    return static_cast<std::size_t>(at - begin);
}

void BlockMatrix::multiply(const Executor& executor, const std::vector<double>& x, std::vector<double>& result) const {
    result.resize(3 * rows());
    executor.each(rows(), [&](std::size_t row) {
        double sum[3]{};
        for (std::uint32_t at = m_first[row]; at < m_first[row + 1]; ++at) {
            const float* a = &m_values[9 * std::size_t(at)];
            const double* of = &x[3 * std::size_t(m_columns[at])];
            for (int k = 0; k < 3; ++k)
                sum[k] += double(a[k]) * of[0] + double(a[k + 3]) * of[1] + double(a[k + 6]) * of[2];
        }
        for (std::size_t k = 0; k < 3; ++k) result[3 * row + k] = sum[k];
    });
}

void IncompleteCholesky::factor(const BlockMatrix& matrix) {
    m_lifted = 0;
    m_first.assign(1, 0);
    m_columns.clear();
    for (std::size_t row = 0; row < matrix.rows(); ++row) {
        for (std::uint32_t at = matrix.first(row); at < matrix.diagonal(row); ++at) m_columns.push_back(matrix.column(at));
        m_first.push_back(static_cast<std::uint32_t>(m_columns.size()));
    }
    m_lower.resize(9 * m_columns.size());
    m_inverse.resize(9 * matrix.rows());
    std::vector<std::int32_t> place(matrix.rows(), -1);
    for (std::size_t row = 0; row < matrix.rows(); ++row) factor_row(matrix, row, place);
}

/// Row i: M_ik = A_ik - Σ L_ij D_j L_kjᵀ over the j that both rows have, L_ik = M_ik D_k⁻¹. While the row is worked on
/// it holds M, so that L_ij D_j need not be formed again.
void IncompleteCholesky::factor_row(const BlockMatrix& matrix, std::size_t row, std::vector<std::int32_t>& place) {
    using Block = BlockMatrix::Block;
    const std::uint32_t begin = m_first[row], end = m_first[row + 1];
    for (std::uint32_t at = begin; at < end; ++at) place[m_columns[at]] = static_cast<std::int32_t>(at);
    Eigen::Matrix3d pivot = ConstBlock(matrix.value(matrix.diagonal(row))).cast<double>();
    for (std::uint32_t at = begin; at < end; ++at) {
        const std::uint32_t k = m_columns[at];
        Block sum = ConstBlock(matrix.value(matrix.first(row) + (at - begin)));
        for (std::uint32_t other = m_first[k]; other < m_first[k + 1]; ++other) {
            const std::int32_t mine = place[m_columns[other]];
            if (mine < 0) continue;
            sum.noalias() -= block_of(m_lower, static_cast<std::size_t>(mine)) * block_of(m_lower, other).transpose();
        }
        block_of(m_lower, at) = sum;
    }
    for (std::uint32_t at = begin; at < end; ++at) {
        Eigen::Map<Block> lower = block_of(m_lower, at);
        const Block unscaled = lower;
        lower.noalias() = unscaled * block_of(m_inverse, m_columns[at]);
        pivot -= (lower * unscaled.transpose()).cast<double>();
        place[m_columns[at]] = -1;
    }
    invert_pivot(row, pivot);
}

void IncompleteCholesky::invert_pivot(std::size_t row, Eigen::Matrix3d pivot) {
    pivot = (pivot + pivot.transpose().eval()) / 2;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    eigen.computeDirect(pivot);
    Eigen::Vector3d values = eigen.eigenvalues();
    const double least = 1e-4 * std::max(values.cwiseAbs().maxCoeff(), 1e-30);
    if (values[0] < least) {
        ++m_lifted;
        values = values.cwiseAbs().cwiseMax(least);
    }
    const Eigen::Matrix3d& axes = eigen.eigenvectors();
    block_of(m_inverse, row) =
        (axes * values.cwiseInverse().asDiagonal() * axes.transpose()).cast<float>();
}

void IncompleteCholesky::apply(const std::vector<double>& residual, std::vector<double>& step) {
    const std::size_t rows = m_first.size() - 1;
    step = residual;
    for (std::size_t row = 0; row < rows; ++row) {
        double* mine = &step[3 * row];
        for (std::uint32_t at = m_first[row]; at < m_first[row + 1]; ++at) {
            const float* l = &m_lower[9 * std::size_t(at)];
            const double* of = &step[3 * std::size_t(m_columns[at])];
            for (int k = 0; k < 3; ++k)
                mine[k] -= double(l[k]) * of[0] + double(l[k + 3]) * of[1] + double(l[k + 6]) * of[2];
        }
    }
    for (std::size_t row = 0; row < rows; ++row) {
        double* mine = &step[3 * row];
        const float* d = &m_inverse[9 * row];
        const double of[3]{mine[0], mine[1], mine[2]};
        for (int k = 0; k < 3; ++k)
            mine[k] = double(d[k]) * of[0] + double(d[k + 3]) * of[1] + double(d[k + 6]) * of[2];
    }
    for (std::size_t row = rows; row-- > 0;) {
        const double* mine = &step[3 * row];
        for (std::uint32_t at = m_first[row]; at < m_first[row + 1]; ++at) {
            const float* l = &m_lower[9 * std::size_t(at)];
            double* of = &step[3 * std::size_t(m_columns[at])];
            for (int k = 0; k < 3; ++k)
                of[k] -= double(l[3 * k]) * mine[0] + double(l[3 * k + 1]) * mine[1] + double(l[3 * k + 2]) * mine[2];
        }
    }
}

CgResult conjugate_gradients(const Executor& executor, const BlockMatrix& matrix, Preconditioner& preconditioner,
                             const std::vector<double>& b, double tolerance, std::size_t most_iterations,
                             std::vector<double>& x) {
    CgResult result;
    x.assign(b.size(), 0);
    std::vector<double> residual = b, step, direction, product;
    preconditioner.apply(residual, step);
    direction = step;
    double work = dot(executor, residual, step);
    const double start = std::sqrt(dot(executor, b, b));
    result.relative = start > 0 ? 1 : 0;
    while (result.iterations < most_iterations && result.relative > tolerance) {
        matrix.multiply(executor, direction, product);
        const double curvature = dot(executor, direction, product);
        if (!(curvature > 0)) {
            result.negative = true;
            result.negative_direction = direction;
            if (result.iterations == 0) x = direction;
            break;
        }
        const double share = work / curvature;
        executor.each(b.size(), [&](std::size_t i) {
            x[i] += share * direction[i];
            residual[i] -= share * product[i];
        });
        preconditioner.apply(residual, step);
        const double next = dot(executor, residual, step);
        result.relative = std::sqrt(dot(executor, residual, residual)) / start;
        ++result.iterations;
        const double turn = next / work;
        executor.each(b.size(), [&](std::size_t i) { direction[i] = step[i] + turn * direction[i]; });
        work = next;
    }
    return result;
}

}  // namespace weave::sim
