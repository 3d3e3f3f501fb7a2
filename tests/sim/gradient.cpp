#include "scenes.hpp"

#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

double greatest(const std::vector<double>& numbers) {
    double most = 0;
    for (const double number : numbers) most = std::max(most, std::abs(number));
    return most;
}

/// Greatest difference between the gradient and central differences of the energy, relative to its greatest
/// entry.
double gradient_error(const SimScene& scene, Terms terms = {}) {
    Bench bench(scene);
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

/// The exact matrix, whole.
Eigen::MatrixXd dense(Bench<double>& bench, Curvature curvature) {
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
Eigen::MatrixXd differences(Bench<double>& bench) {
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
void check_matrices(const SimScene& scene) {
    Bench bench(scene);
    const Eigen::MatrixXd exact = dense(bench, Curvature::exact), wanted = differences(bench);
    const double scale = wanted.cwiseAbs().maxCoeff();
    CHECK((exact - wanted).cwiseAbs().maxCoeff() < 3e-6 * scale);
    CHECK((exact - exact.transpose()).cwiseAbs().maxCoeff() < 1e-6 * scale);
    const Eigen::MatrixXd convex = dense(bench, Curvature::convex);
    CHECK((convex - convex.transpose()).cwiseAbs().maxCoeff() < 1e-6 * scale);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(convex);
    CHECK(eigen.eigenvalues()[0] > -1e-6 * eigen.eigenvalues()[convex.rows() - 1]);
}

SimYarn only(SimYarn yarn, bool stretches, bool bends) {
    if (!stretches) yarn.stretch_N = 0;
    if (!bends) yarn.bending_N_mm2 = 0;
    return yarn;
}

/// One crooked yarn with uneven points.
SimScene crooked(Random& random, const SimYarn& kind, bool is_periodic) {
    SimScene scene;
    scene.is_periodic = {is_periodic, false};
    scene.period_mm = {2, 0};
    const std::size_t points = random.between(is_periodic ? 1 : 3, 7);
    SimYarn yarn = laid(kind, {0, 0, 0}, {2, 0, 0}, points, is_periodic);
    yarn.rest_mm = uniform(random, 1.5, 2.5);
    yarn.turns = {is_periodic ? 1 : 0, 0};
    shake(random, yarn, 0.4 / static_cast<double>(points));
    scene.yarns = {yarn};
    return scene;
}

}  // namespace

TEST_CASE("stretch and bending pull as their energies say, and curve as their pulls say") {
    weave::testing::for_all(
        [](Random& random) {
            SimYarn kind = only(usual_yarn(0.01), random.coin(), true);
            kind.is_fed = random.coin();
            if (random.between(0, 2) == 0) kind = only(kind, true, false), kind.stretch_N = 40;
            SimScene scene = crooked(random, kind, random.coin());
            INFO("fed " << kind.is_fed << ", EA " << kind.stretch_N << ", EI " << kind.bending_N_mm2
                        << ", points " << scene.yarns[0].control.size() << ", periodic "
                        << scene.yarns[0].is_periodic);
            if (scene.yarns[0].control.size() < 2) return;  // straight whatever its one point does
            CHECK(gradient_error(scene, {.elastic = true, .contact = false}) < 1e-6);
            check_matrices(scene);
        },
        60);
}

TEST_CASE("contact pulls as its energy says, equal and mixed radii, open ends, frozen points") {
    std::size_t touching = 0;
    weave::testing::for_all(
        [&](Random& random) {
            SimScene scene = heap(random, random.between(2, 4), random.coin() ? 0.12 : 0.04);
            if (random.coin()) {
                for (SimYarn& yarn : scene.yarns) {
                    yarn.frozen.assign(yarn.control.size(), 0);
                    for (std::uint8_t& frozen : yarn.frozen) frozen = random.between(0, 3) == 0;
                }
            }
            Bench bench(scene);
            bench.evaluate({.elastic = false, .contact = true});
            if (greatest(bench.gradient) > 1e-3) {
                CHECK(gradient_error(scene, {.elastic = false, .contact = true}) < 1e-6);
                ++touching;
            }
            CHECK(gradient_error(scene) < 1e-6);
            check_matrices(scene);
        },
        20);
    CHECK(touching > 10);
}

TEST_CASE("contact with periodic images pulls as its energy says") {
    weave::testing::for_all(
        [](Random& random) {
            WeaveShape shape;
            shape.points_a_crossing = random.between(1, 3);
            shape.pitch_mm = uniform(random, 0.3, 0.6);
            shape.swing = 0.7;
            SimScene scene = plain_weave(shape);
            if (random.coin()) scene.yarns.erase(scene.yarns.begin() + 1);
            for (SimYarn& yarn : scene.yarns) shake(random, yarn, 0.02);
            CHECK(gradient_error(scene, {.elastic = false, .contact = true}) < 1e-6);
            check_matrices(scene);
        },
        8);
}

TEST_CASE("a period shorter than the yarns are thick counts every image") {
    weave::testing::for_all(
        [](Random& random) {
            SimScene scene;
            scene.is_periodic = {true, true};
            scene.period_mm = {1.2, 0.1};  // a yarn of 0.24 touches two images on either side
            SimYarn yarn = laid(usual_yarn(), {0, 0, 0}, {1.2, 0, 0}, 5, true);
            yarn.turns = {1, 0};
            shake(random, yarn, 0.02);
            scene.yarns = {yarn};
            CHECK(gradient_error(scene, {.elastic = false, .contact = true}) < 1e-6);
            check_matrices(scene);
        },
        4);
}

TEST_CASE("fields and gravity pull as their energies say, and curve as their pulls say") {
    weave::testing::for_all(
        [](Random& random) {
            SimScene scene = heap(random, 2);
            if (random.coin()) scene.gravity_mm_ms2 = 9.80665e-3;
            for (SimYarn& yarn : scene.yarns) {
                yarn.gram_per_mm = uniform(random, 0, 100);
                yarn.is_fed = random.coin();
            }
            scene.fields.push_back(
                {.centre_mm = {0.1, 0.1, -0.2}, .radius_mm = 0.9, .strength_N_per_mm = uniform(random, -4, 4)});
            if (random.coin())
                scene.fields.push_back(
                    {.centre_mm = {-0.3, 0, 0.3}, .radius_mm = 0.5, .strength_N_per_mm = 6});
            CHECK(gradient_error(scene) < 1e-6);
            check_matrices(scene);
        },
        20);
}

TEST_CASE("the gradient in float is the one in double as far as float goes") {
    weave::testing::for_all(
        [](Random& random) {
            const SimScene scene = heap(random, 4, 0.06);
            Bench<double> fine(scene);
            Bench<float> coarse(scene);
            const double energy = fine.evaluate();
            CHECK(coarse.evaluate() == Approx(energy).epsilon(1e-5));
            const double scale = greatest(fine.gradient);
            for (std::size_t i = 0; i < fine.gradient.size(); ++i)
                CHECK(std::abs(fine.gradient[i] - static_cast<double>(coarse.gradient[i])) < 1e-4 * scale);
        },
        20);
}
