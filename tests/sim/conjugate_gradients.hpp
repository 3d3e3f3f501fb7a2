#pragma once

#include <weave/sim/block_matrix.hpp>

#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace weave::sim::testing {

/// How a run of conjugate gradients ended.
struct CgResult {
    std::size_t iterations = 0;
    bool negative = false;  ///< met a direction in which A does not curve upwards
    double relative = 0;    ///< |b - A·x| / |b|
    std::vector<double> negative_direction;
};

/// Conjugate gradients for A·x = b from x = 0, as in the textbook: what a preconditioner is worth shows in their number. Ends
/// where the residual has fallen to `tolerance` of |b|, or at a direction of negative curvature with the best x so far.
inline CgResult conjugate_gradients(const Executor& executor, const BlockMatrix& matrix, Preconditioner& preconditioner, const std::vector<double>& b,
                                    double tolerance, std::size_t most_iterations, std::vector<double>& x) {
    const auto of = [](std::vector<double>& list) { return Eigen::Map<Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size())); };
    CgResult result;
    x.assign(b.size(), 0);
    std::vector<double> residual = b, step, product;
    preconditioner.apply(residual, step);
    std::vector<double> direction = step;
    const double start = of(residual).norm();
    double work = of(residual).dot(of(step));
    result.relative = start > 0 ? 1 : 0;
    while (result.iterations < most_iterations && result.relative > tolerance) {
        matrix.multiply(executor, direction, product);
        const double curvature = of(direction).dot(of(product));
        if (!(curvature > 0)) {
            result.negative = true;
            result.negative_direction = direction;
            if (result.iterations == 0) x = direction;
            break;
        }
        of(x) += work / curvature * of(direction);
        of(residual) -= work / curvature * of(product);
        preconditioner.apply(residual, step);
        const double next = of(residual).dot(of(step));
        of(direction) = of(step) + next / work * of(direction);
        work = next;
        result.relative = of(residual).norm() / start;
        ++result.iterations;
    }
    return result;
}

}  // namespace weave::sim::testing
