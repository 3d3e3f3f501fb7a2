#include "conjugate_gradients.hpp"
#include "scenes.hpp"

#include <weave/sim/block_matrix.hpp>
#include <weave/sim/multigrid.hpp>

#include <catch2/catch.hpp>

#include <algorithm>

using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

/// A symmetric matrix whole and in blocks; `reach` is how far its band goes, `links` how many blocks lie
/// anywhere.
struct Example {
    BlockMatrix blocks;
    Eigen::MatrixXd whole;

    Example(Random& random, std::size_t rows, std::size_t reach, std::size_t links) {
        const auto size = static_cast<Eigen::Index>(rows);
        whole = Eigen::MatrixXd::Zero(3 * size, 3 * size);
        for (Eigen::Index i = 0; i < size; ++i) {
            for (Eigen::Index j = i; j < std::min(size, i + 1 + static_cast<Eigen::Index>(reach)); ++j)
                link(random, i, j);
        }
        for (std::size_t k = 0; k < links; ++k)
            link(random, static_cast<Eigen::Index>(random.between(0, rows - 1)),
                 static_cast<Eigen::Index>(random.between(0, rows - 1)));
        shape();
    }

    /// Adds VᵀV by both rows, so that the whole stays positive; the diagonal a little more.
    void link(Random& random, Eigen::Index i, Eigen::Index j) {
        Eigen::Matrix<double, 3, 6> v;
        for (Eigen::Index k = 0; k < 18; ++k) v(k / 6, k % 6) = uniform(random, -1, 1);
        const Eigen::Matrix<double, 6, 6> square = v.transpose() * v;
        if (i == j) {
            whole.block<3, 3>(3 * i, 3 * i) += square.block<3, 3>(0, 0) + 0.2 * Eigen::Matrix3d::Identity();
            return;
        }
        whole.block<3, 3>(3 * i, 3 * i) += square.block<3, 3>(0, 0);
        whole.block<3, 3>(3 * j, 3 * j) += square.block<3, 3>(3, 3);
        whole.block<3, 3>(3 * i, 3 * j) += square.block<3, 3>(0, 3);
        whole.block<3, 3>(3 * j, 3 * i) += square.block<3, 3>(3, 0);
    }

    /// Brings the whole matrix, as float, into blocks.
    void shape() {
        whole = whole.cast<float>().cast<double>();
        std::vector<std::uint32_t> first{0}, columns;
        for (Eigen::Index i = 0; i < whole.rows() / 3; ++i) {
            for (Eigen::Index j = 0; j < whole.rows() / 3; ++j) {
                if (whole.block<3, 3>(3 * i, 3 * j).cwiseAbs().maxCoeff() > 0)
                    columns.push_back(static_cast<std::uint32_t>(j));
            }
            first.push_back(static_cast<std::uint32_t>(columns.size()));
        }
        blocks.shape(first, columns);
        for (std::size_t row = 0; row < blocks.rows(); ++row) {
            for (std::size_t at = blocks.first(row); at < blocks.first(row + 1); ++at) {
                Eigen::Map<BlockMatrix::Block>(blocks.value(at)) =
                    whole
                        .block<3, 3>(static_cast<Eigen::Index>(3 * row),
                                     3 * static_cast<Eigen::Index>(blocks.column(at)))
                        .cast<float>();
            }
        }
    }

    [[nodiscard]] std::vector<double> right_side(Random& random) const {
        std::vector<double> b;
        for (Eigen::Index i = 0; i < whole.rows(); ++i) b.push_back(uniform(random, -1, 1));
        return b;
    }
    [[nodiscard]] Eigen::VectorXd solved(const std::vector<double>& b) const {
        return whole.ldlt().solve(Eigen::Map<const Eigen::VectorXd>(b.data(), whole.rows()));
    }
};

double difference(const std::vector<double>& x, const Eigen::VectorXd& wanted) {
    return (Eigen::Map<const Eigen::VectorXd>(x.data(), wanted.size()) - wanted).norm() / wanted.norm();
}

/// No preconditioning at all.
struct Plain : Preconditioner {
    void apply(const std::vector<double>& residual, std::vector<double>& step) override { step = residual; }
};

}  // namespace

TEST_CASE("a block matrix multiplies as the whole one, and clears") {
    weave::testing::for_all(
        [](Random& random) {
            Example example(random, random.between(1, 20), random.between(0, 3), random.between(0, 20));
            const std::vector<double> x = example.right_side(random);
            std::vector<double> product;
            example.blocks.multiply(Executor(1), x, product);
            CHECK(difference(product, example.whole * Eigen::Map<const Eigen::VectorXd>(
                                                          x.data(), example.whole.rows())) < 1e-14);
            example.blocks.clear_values();
            example.blocks.multiply(Executor(1), x, product);
            CHECK(std::all_of(product.begin(), product.end(), [](double number) { return number == 0; }));
        },
        50);
}

TEST_CASE("conjugate gradients solve as the whole matrix does, sooner with a preconditioner") {
    std::size_t plain_iterations = 0, iterations = 0;
    weave::testing::for_all(
        [&](Random& random) {
            const Example example(random, random.between(1, 40), 3, random.between(0, 20));
            const std::vector<double> b = example.right_side(random);
            const Eigen::VectorXd wanted = example.solved(b);
            std::vector<double> x;
            Plain none;
            const CgResult plain = conjugate_gradients(Executor(1), example.blocks, none, b, 1e-12, 2000, x);
            CHECK(difference(x, wanted) < 1e-8);
            CHECK_FALSE(plain.negative);
            const Executor executor(1);
            Multigrid factor(executor, {{0, static_cast<std::uint32_t>(example.blocks.rows()), false}});
            factor.factor(example.blocks);
            const CgResult result =
                conjugate_gradients(Executor(1), example.blocks, factor, b, 1e-12, 2000, x);
            CHECK(difference(x, wanted) < 1e-8);
            CHECK(result.relative <= 1e-12);
            const Eigen::VectorXd left =
                Eigen::Map<const Eigen::VectorXd>(b.data(), wanted.size()) -
                example.whole * Eigen::Map<const Eigen::VectorXd>(x.data(), wanted.size());
            CHECK(left.norm() < 1e-10 * Eigen::Map<const Eigen::VectorXd>(b.data(), wanted.size()).norm());
            plain_iterations += plain.iterations;
            iterations += result.iterations;
        },
        30);
    CHECK(iterations * 2 < plain_iterations);
}

TEST_CASE("conjugate gradients tell of a direction that curves down, and stop as told") {
    weave::testing::for_all(
        [](Random& random) {
            Example example(random, random.between(2, 20), 2, 4);
            const std::vector<double> b = example.right_side(random);
            std::vector<double> x;
            Plain none;
            const CgResult few = conjugate_gradients(Executor(1), example.blocks, none, b, 1e-12, 2, x);
            CHECK(few.iterations == 2);
            CHECK(few.relative > 1e-12);

            example.whole(0, 0) = -50;
            example.shape();
            const CgResult result = conjugate_gradients(Executor(1), example.blocks, none, b, 1e-12, 2000, x);
            REQUIRE(result.negative);
            const Eigen::Map<const Eigen::VectorXd> down(result.negative_direction.data(),
                                                         example.whole.rows());
            CHECK(down.dot(example.whole * down) <= 0);

            const std::vector<double> nothing(b.size(), 0.0);
            CHECK(
                conjugate_gradients(Executor(1), example.blocks, none, nothing, 1e-12, 2000, x).iterations ==
                0);
            CHECK(x == nothing);
        },
        20);
}
