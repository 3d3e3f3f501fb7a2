#include <weave/sim/block_matrix.hpp>

#include <algorithm>
#include <cmath>

namespace weave::sim {

namespace {

/// Four numbers that are worked on at once.
typedef double Four __attribute__((vector_size(32), aligned(8), may_alias));
typedef float FourFloats __attribute__((vector_size(16), aligned(4), may_alias));

WEAVE_WIDE double dot_of(const double* a, const double* b, std::size_t count) {
    Four sums[2]{};
    std::size_t i = 0;
    for (; i + 8 <= count; i += 8) {
        sums[0] += *reinterpret_cast<const Four*>(a + i) * *reinterpret_cast<const Four*>(b + i);
        sums[1] += *reinterpret_cast<const Four*>(a + i + 4) * *reinterpret_cast<const Four*>(b + i + 4);
    }
    const Four both = sums[0] + sums[1];
    double sum = (both[0] + both[1]) + (both[2] + both[3]);
    for (; i < count; ++i) sum += a[i] * b[i];
    return sum;
}

double dot(const Executor& executor, const std::vector<double>& a, const std::vector<double>& b) {
    return executor.sum_of_ranges(a.size(), [&](std::size_t first, std::size_t last) {
        return dot_of(&a[first], &b[first], last - first);
    });
}

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

/// One step along a direction, and how much of the residual is left: |residual|².
WEAVE_WIDE double advance(double share, const double* direction, const double* product, double* x, double* residual,
                          std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        x[i] += share * direction[i];
        residual[i] -= share * product[i];
    }
    return dot_of(residual, residual, count);
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
        const double left = executor.sum_of_ranges(b.size(), [&](std::size_t first, std::size_t last) {
            return advance(share, &direction[first], &product[first], &x[first], &residual[first], last - first);
        });
        preconditioner.apply(residual, step);
        const double next = dot(executor, residual, step);
        result.relative = std::sqrt(left) / start;
        ++result.iterations;
        const double turn = next / work;
        executor.ranges(b.size(), [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) direction[i] = step[i] + turn * direction[i];
        });
        work = next;
    }
    return result;
}

}  // namespace weave::sim
