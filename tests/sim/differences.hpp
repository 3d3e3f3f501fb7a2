#pragma once

#include "scenes.hpp"

#include <weave/sim/hessian.hpp>

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

// Gradients and matrices against finite differences.

namespace weave::sim::testing {

inline double greatest(const std::vector<double>& numbers) {
    double most = 0;
    for (const double number : numbers) most = std::max(most, std::abs(number));
    return most;
}

/// Greatest difference between the gradient and central differences of the energy, relative to its greatest
/// entry.
inline double gradient_error(Bench<double>& bench, Terms terms = {}) {
    bench.evaluate(terms);
    const std::vector<double> gradient = bench.gradient;
    const double step = 1e-6, scale = greatest(gradient);
    REQUIRE(scale > 1e-6);
    double worst = 0;
    for (std::size_t slot = 0; slot < bench.fabric.slots(); ++slot) {
        for (std::size_t i = 3 * slot; i < 3 * slot + 3; ++i) {
            if (bench.fabric.moves()[slot] == 0) {
                CHECK(gradient[i] == 0);
                continue;
            }
            std::vector<double> more = bench.state, less = bench.state;
            more[i] += step;
            less[i] -= step;
            const double slope = (bench.energy_at(more, terms) - bench.energy_at(less, terms)) / (2 * step);
            worst = std::max(worst, std::abs(slope - gradient[i]));
        }
    }
    return worst / scale;
}

inline double gradient_error(const SimScene& scene, Terms terms = {}) {
    Bench bench(scene);
    return gradient_error(bench, terms);
}

/// The exact matrix, whole.
inline Eigen::MatrixXd dense(Bench<double>& bench, Curvature curvature) {
    bench.evaluate();
    Hessian<double> hessian(bench.fabric);
    BlockMatrix matrix;
    hessian.assemble(bench.energy, bench.state, curvature, matrix);
    const auto rows = static_cast<Eigen::Index>(matrix.rows());
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(3 * rows, 3 * rows);
    for (std::size_t row = 0; row < matrix.rows(); ++row) {
        for (std::size_t at = matrix.first(row); at < matrix.first(row + 1); ++at) {
            whole.block<3, 3>(static_cast<Eigen::Index>(3 * row),
                              3 * static_cast<Eigen::Index>(matrix.column(at))) =
                Eigen::Map<const BlockMatrix::Block>(matrix.value(at)).cast<double>();
        }
    }
    return whole;
}

/// The matrix of central differences of the gradient. A pair that begins to touch within a step would spoil
/// them, for the contact law bends there at once; so steps are as small as numbers allow.
inline Eigen::MatrixXd differences(Bench<double>& bench) {
    const Hessian<double> hessian(bench.fabric);
    const double step = 1e-8;
    const auto size = static_cast<Eigen::Index>(3 * hessian.rows());
    Eigen::MatrixXd whole(size, size);
    for (Eigen::Index i = 0; i < size; ++i) {
        std::vector<double> rows[2];
        for (const int side : {0, 1}) {
            std::vector<double> state = bench.state, gradient;
            const auto at = static_cast<std::size_t>(i);
            state[3 * hessian.slot_of_row()[at / 3] + at % 3] += side == 0 ? step : -step;
            bench.fabric.follow(state);
            bench.energy.evaluate(state, gradient);
            hessian.to_rows(gradient, rows[side]);
        }
        for (Eigen::Index j = 0; j < size; ++j)
            whole(j, i) =
                (rows[0][static_cast<std::size_t>(j)] - rows[1][static_cast<std::size_t>(j)]) / (2 * step);
    }
    return whole;
}

/// Checks the exact matrix against differences, and that the convex one curves nowhere down. Entries are
/// float.
inline void check_matrices(Bench<double>& bench) {
    const Eigen::MatrixXd exact = dense(bench, Curvature::exact), wanted = differences(bench);
    const double scale = wanted.cwiseAbs().maxCoeff();
    CHECK((exact - wanted).cwiseAbs().maxCoeff() < 3e-6 * scale);
    CHECK((exact - exact.transpose()).cwiseAbs().maxCoeff() < 1e-6 * scale);
    const Eigen::MatrixXd convex = dense(bench, Curvature::convex);
    CHECK((convex - convex.transpose()).cwiseAbs().maxCoeff() < 1e-6 * scale);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(convex);
    CHECK(eigen.eigenvalues()[0] > -1e-6 * eigen.eigenvalues()[convex.rows() - 1]);
}

inline void check_matrices(const SimScene& scene) {
    Bench bench(scene);
    check_matrices(bench);
}

}  // namespace weave::sim::testing
