#pragma once

#include <weave/sim/bodies.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace weave::sim {

/// No direction of a pivot counts as softer than this share of its stiffest.
inline constexpr double softest_direction = 1e-4;

/// The inverse of a symmetric pivot. One that is not positive is made so: a direction that curves down counts as one that curves
/// up as much.
WEAVE_HD inline Mat<double> inverse_of_pivot(const Mat<double>& pivot) {
    const double trace = pivot.trace(), minor = pivot(0, 0) * pivot(1, 1) - pivot(0, 1) * pivot(0, 1),
                 volume = pivot.determinant();
    // All three directions are positive, and the softest is no less than 4·volume / trace².
    if (pivot(0, 0) > 0 && minor > 0 && 4 * volume > softest_direction * trace * trace * trace) {
        const Mat<double> inverse = pivot.inverse();
        return inverse;
    }
    Eigen::SelfAdjointEigenSolver<Mat<double>> eigen;
    eigen.computeDirect(pivot);
    const Vec<double> sizes = eigen.eigenvalues().cwiseAbs();
    const double least = softest_direction * std::max(sizes.maxCoeff(), 1e-30);
    const Mat<double>& axes = eigen.eigenvectors();
    const Vec<double> inverses = sizes.cwiseMax(least).cwiseInverse();
    return axes * inverses.asDiagonal() * axes.transpose();
}

}  // namespace weave::sim
