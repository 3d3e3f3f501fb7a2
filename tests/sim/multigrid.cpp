#include "conjugate_gradients.hpp"
#include "scenes.hpp"

#include <weave/sim/multigrid.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

/// A weave of many yarns, bent into long waves and a little crooked, with its convex matrix.
struct BentCloth {
    Bench<double> bench;
    Hessian<double> hessian{bench.fabric};
    BlockMatrix matrix;
    std::vector<double> force;

    BentCloth(Random& random, std::size_t count, std::size_t threads = 1)
        : bench(scene_of(random, count), threads) {
        bench.evaluate();
        hessian.assemble(bench.energy, bench.state, Curvature::convex, matrix);
        hessian.to_rows(bench.gradient, force);
        // A sheet can move as a whole: a little damping holds it.
        for (std::size_t row = 0; row < matrix.rows(); ++row) {
            float* pivot = matrix.value(matrix.diagonal(row));
            for (int k = 0; k < 9; k += 4) pivot[k] *= 1 + 1e-5F;
        }
    }

    static SimScene scene_of(Random& random, std::size_t count) {
        SimScene scene = plain_weave({.count = count});
        for (SimYarn& yarn : scene.yarns) {
            for (Vec3& point : yarn.control)
                point.z() += 0.3 * std::sin(2 * std::numbers::pi * point.x() / scene.period_mm[0]);
            shake(random, yarn, 0.002);
        }
        return scene;
    }

    /// The same force all over the sheet, up here and down there: what long waves answer to.
    [[nodiscard]] std::vector<double> long_wave() const {
        std::vector<double> load(3 * matrix.rows(), 0.0);
        for (std::size_t row = 0; row < matrix.rows(); ++row) {
            const double x = bench.state[3 * std::size_t(hessian.slot_of_row()[row])];
            load[3 * row + 2] = std::sin(2 * std::numbers::pi * x / bench.fabric.scene().period_mm[0]);
        }
        return load;
    }
};

/// The inverse of single pivots alone.
struct PivotsOnly : Preconditioner {
    const BlockMatrix& matrix;

    explicit PivotsOnly(const BlockMatrix& of) : matrix(of) {}
    void apply(const std::vector<double>& residual, std::vector<double>& step) override {
        step.resize(residual.size());
        for (std::size_t row = 0; row < matrix.rows(); ++row) {
            const Eigen::Matrix3d pivot =
                Eigen::Map<const BlockMatrix::Block>(matrix.value(matrix.diagonal(row))).cast<double>();
            Eigen::Map<Eigen::Vector3d> to(&step[3 * row]);
            to = pivot.ldlt().solve(Eigen::Map<const Eigen::Vector3d>(&residual[3 * row]));
        }
    }
};

Eigen::MatrixXd whole_of(Preconditioner& preconditioner, std::size_t rows) {
    const auto size = static_cast<Eigen::Index>(3 * rows);
    Eigen::MatrixXd whole(size, size);
    for (Eigen::Index i = 0; i < size; ++i) {
        std::vector<double> unit(static_cast<std::size_t>(size), 0.0), column;
        unit[static_cast<std::size_t>(i)] = 1;
        preconditioner.apply(unit, column);
        whole.col(i) = Eigen::Map<const Eigen::VectorXd>(column.data(), size);
    }
    return whole;
}

}  // namespace

TEST_CASE("the rows of each yarn are found, closed where nothing of it is frozen") {
    Random random(1);
    SimScene scene = plain_weave({.count = 2});
    scene.yarns[1].frozen.assign(scene.yarns[1].control.size(), 0);
    scene.yarns[1].frozen[2] = 1;
    scene.yarns[2].frozen.assign(scene.yarns[2].control.size(), 1);
    const Bench bench(scene);
    const std::vector<YarnRows> yarns = rows_of_yarns(bench.fabric);
    REQUIRE(yarns.size() == 3);
    const auto points = static_cast<std::uint32_t>(scene.yarns[0].control.size());
    CHECK((yarns[0].first == 0 && yarns[0].rows == points && yarns[0].is_closed));
    CHECK((yarns[1].first == points && yarns[1].rows == points - 1 && !yarns[1].is_closed));
    CHECK((yarns[2].first == 2 * points - 1 && yarns[2].rows == points && yarns[2].is_closed));
}

TEST_CASE("the multigrid is symmetric and positive, for matrices that curve down too") {
    weave::testing::for_all(
        [](Random& random) {
            BentCloth cloth(random, 7);
            if (random.coin()) {
                cloth.hessian.assemble(cloth.bench.energy, cloth.bench.state, Curvature::exact, cloth.matrix);
                for (std::size_t row = 0; row < cloth.matrix.rows(); row += 5)
                    cloth.matrix.value(cloth.matrix.diagonal(row))[4] -= 100;
            }
            Multigrid multigrid(cloth.bench.executor, rows_of_yarns(cloth.bench.fabric));
            REQUIRE(multigrid.levels() > 1);
            multigrid.factor(cloth.matrix);
            const Eigen::MatrixXd inverse = whole_of(multigrid, cloth.matrix.rows());
            CHECK((inverse - inverse.transpose()).cwiseAbs().maxCoeff() <
                  1e-10 * inverse.cwiseAbs().maxCoeff());
            const Eigen::LLT<Eigen::MatrixXd> positive(inverse + inverse.transpose());
            CHECK(positive.info() == Eigen::Success);
        },
        4);
}

TEST_CASE("few rows are solved as a whole") {
    Random random(weave::testing::run_seed());
    INFO("WEAVE_SEED=" << weave::testing::run_seed());
    const BentCloth cloth(random, 2);
    Multigrid multigrid(cloth.bench.executor, rows_of_yarns(cloth.bench.fabric));
    CHECK(multigrid.levels() == 1);
    multigrid.factor(cloth.matrix);
    std::vector<double> x;
    const CgResult result =
        conjugate_gradients(cloth.bench.executor, cloth.matrix, multigrid, cloth.force, 1e-3, 100, x);
    CHECK(result.iterations <= 3);
}

TEST_CASE("on a bent cloth conjugate gradients need fewer steps with the multigrid than with single pivots") {
    Random random(weave::testing::run_seed());
    INFO("WEAVE_SEED=" << weave::testing::run_seed());
    for (const std::size_t count : {8, 24}) {
        const BentCloth cloth(random, count);
        const std::vector<double> load = cloth.long_wave();
        std::vector<double> x;
        PivotsOnly pivots(cloth.matrix);
        const CgResult plain =
            conjugate_gradients(cloth.bench.executor, cloth.matrix, pivots, load, 1e-3, 5000, x);
        Multigrid multigrid(cloth.bench.executor, rows_of_yarns(cloth.bench.fabric));
        multigrid.factor(cloth.matrix);
        const CgResult result =
            conjugate_gradients(cloth.bench.executor, cloth.matrix, multigrid, load, 1e-3, 5000, x);
        CHECK_FALSE(result.negative);
        CHECK(result.relative <= 1e-3);
        CHECK(4 * result.iterations < 3 * plain.iterations);
    }
}

TEST_CASE("a bundle of yarns of one point each still has a last level") {
    // 300 yarns of a single row: only bundles of them can be pieces.
    std::vector<YarnRows> yarns;
    std::vector<std::uint32_t> first{0}, columns;
    for (std::uint32_t row = 0; row < 300; ++row) {
        yarns.push_back({row, 1, false});
        columns.push_back(row);
        first.push_back(row + 1);
    }
    BlockMatrix matrix;
    matrix.shape(first, columns);
    for (std::size_t row = 0; row < matrix.rows(); ++row) {
        for (int k = 0; k < 9; k += 4) matrix.value(matrix.diagonal(row))[k] = 2;
    }
    const Executor executor(1);
    Multigrid multigrid(executor, yarns);
    CHECK(multigrid.levels() == 3);  // 75 bundles, and 19 of these
    multigrid.factor(matrix);
    std::vector<double> x;
    const std::vector<double> b(900, 1.0);
    const CgResult result = conjugate_gradients(executor, matrix, multigrid, b, 1e-10, 50, x);
    CHECK(result.relative <= 1e-10);
    for (const double number : x) CHECK(number == Approx(0.5));
}

TEST_CASE("the multigrid is the same bit for bit on one thread and on three") {
    const std::uint64_t seed = weave::testing::run_seed();
    INFO("WEAVE_SEED=" << seed);
    Random random(seed), same(seed);
    const BentCloth one(random, 24, 1), three(same, 24, 3);
    std::vector<double> first, second;
    Multigrid a(one.bench.executor, rows_of_yarns(one.bench.fabric)),
        b(three.bench.executor, rows_of_yarns(three.bench.fabric));
    a.factor(one.matrix);
    b.factor(three.matrix);
    a.apply(one.force, first);
    b.apply(three.force, second);
    CHECK(first == second);
}
