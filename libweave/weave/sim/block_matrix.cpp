#include <weave/sim/block_matrix.hpp>

#include <algorithm>
#include <cmath>

namespace weave::sim {

namespace {

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

void BlockMatrix::add_to_pivots(float share) {
    for (std::size_t row = 0; row < rows(); ++row) {
        float* pivot = value(diagonal(row));
        const float mean = (std::abs(pivot[0]) + std::abs(pivot[4]) + std::abs(pivot[8])) / 3;
        for (int k = 0; k < 9; k += 4) pivot[k] += share * std::max(1e-12F, mean);
    }
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
