#include "lists_here.hpp"

#include <weave/sim/device/piece_arrays.hpp>
#include <weave/sim/device/pieces_apply.hpp>
#include <weave/sim/multigrid.hpp>

#include <catch2/catch.hpp>

#include <Eigen/Dense>

#include <memory>

using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

/// A matrix of the processor in a memory.
struct UploadedMatrix {
    Array<std::uint32_t> first, column, diagonal;
    Array<float> value;

    UploadedMatrix(Memory& memory, const BlockMatrix& matrix)
        : first(memory, matrix.rows() + 1), column(memory, matrix.blocks()), diagonal(memory, matrix.rows()),
          value(memory, 9 * matrix.blocks()) {
        for (std::size_t row = 0; row < matrix.rows(); ++row) {
            first.view()[row + 1] = matrix.first(row + 1);
            diagonal.view()[row] = matrix.diagonal(row);
        }
        for (std::size_t at = 0; at < matrix.blocks(); ++at) {
            column.view()[at] = matrix.column(at);
            std::copy_n(matrix.value(at), 9, value.view().at(9 * at, 9));
        }
    }
    [[nodiscard]] MatrixView view() const {
        return {static_cast<std::uint32_t>(diagonal.size()), first.view(), column.view(), diagonal.view(), value.view()};
    }
};

/// A crooked cloth with its matrix on the processor and in a memory.
struct CrookedCloth {
    Bench<double> bench;
    Hessian<double> hessian{bench.fabric};
    BlockMatrix matrix;
    HostMemory memory;
    std::unique_ptr<UploadedMatrix> uploaded;

    CrookedCloth(const SimScene& scene, Curvature curvature) : bench(scene) {
        bench.evaluate();
        hessian.assemble(bench.energy, bench.state, curvature, matrix);
        matrix.add_to_pivots(1e-3F);
        upload();
    }
    void upload() { uploaded = std::make_unique<UploadedMatrix>(memory, matrix); }

    [[nodiscard]] std::vector<double> random_load(Random& random) const {
        std::vector<double> load(3 * matrix.rows());
        for (double& number : load) number = uniform(random, -1, 1);
        return load;
    }
};

SimScene crooked(Random& random, const WeaveShape& shape, bool is_held = false) {
    SimScene scene = plain_weave(shape);
    for (SimYarn& yarn : scene.yarns) {
        shake(random, yarn, 0.01);
        yarn.frozen.assign(yarn.control.size(), 0);
        for (std::uint8_t& frozen : yarn.frozen) frozen = is_held && random.between(0, 4) == 0;
    }
    return scene;
}

/// The multigrid on a device as a preconditioner of the processor's.
template <class Real>
struct DeviceMultigrid : Preconditioner {
    CrewKind kind;
    Memory& memory;
    MatrixView matrix;
    PieceArrays<Real> pieces;
    int grown = 0;

    DeviceMultigrid(CrewKind by, CrookedCloth& cloth, const Hierarchy& hierarchy)
        : kind(by), memory(cloth.memory), matrix(cloth.uploaded->view()), pieces(cloth.memory, hierarchy) {}

    void factor() {
        while (!by_crew(kind, [&](auto& crew) { return shape_pieces(crew, matrix, pieces.view()); })) {
            REQUIRE(++grown < 20);
            pieces.grow();
        }
        by_crew(kind, [&](auto& crew) {
            weave::sim::factor(crew, matrix, pieces.view());
            return true;
        });
    }

    void apply(const std::vector<double>& residual, std::vector<double>& step) override {
        const Array<Real> from(memory, std::vector<Real>(residual.begin(), residual.end())), to(memory, residual.size());
        by_crew(kind, [&](auto& crew) {
            weave::sim::apply(crew, pieces.view(), from.view(), to.view());
            return true;
        });
        const std::vector<Real> numbers = to.get();
        step.assign(numbers.begin(), numbers.end());
    }
};

double farthest(const std::vector<double>& a, const std::vector<double>& b) {
    double most = 0, size = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        size = std::max(size, std::abs(b[i]));
        if (const double off = std::abs(a[i] - b[i]); !(off <= most)) most = off;
    }
    return most / size;
}

}  // namespace

TEST_CASE("pieces: the multigrid on a device is the processor's", "[device]") {
    const std::uint64_t seed = weave::testing::run_seed();
    INFO("WEAVE_SEED=" << seed);
    Random random(seed);
    const WeaveShape small{.count = 2}, some{.count = 6}, many{.count = 20};
    for (const WeaveShape& shape : {small, some, many}) {
        for (const bool is_held : {false, true}) {
            for (const Curvature curvature : {Curvature::convex, Curvature::exact}) {
                CrookedCloth cloth(crooked(random, shape, is_held), curvature);
                for (const bool grids : {false, true}) {
                    const RowPlaces places = grids ? places_of(cloth.bench.fabric) : RowPlaces{};
                    const Hierarchy hierarchy(rows_of_yarns(cloth.bench.fabric), places);
                    Multigrid right(cloth.bench.executor, rows_of_yarns(cloth.bench.fabric), places);
                    right.factor(cloth.matrix);
                    const std::vector<double> load = cloth.random_load(random);
                    std::vector<double> step, same;
                    right.apply(load, step);
                    INFO("points " << shape.count << ", held " << is_held << ", grids " << grids);
                    const CrewKind kind = every_crew[random.between(0, shape.count < 20 ? 2 : 0)];
                    DeviceMultigrid<double> device(kind, cloth, hierarchy);
                    device.factor();
                    device.apply(load, same);
                    CHECK(farthest(same, step) < 1e-6);  // measured over 40 seeds: 1.4e-7
                    DeviceMultigrid<float> in_float(kind, cloth, hierarchy);
                    in_float.factor();
                    in_float.apply(load, same);
                    CHECK(farthest(same, step) < 5e-6);  // 5.1e-7
                }
            }
        }
    }
}

TEST_CASE("pieces: every crew comes to the same step, to the bit of its sums", "[device]") {
    Random random(weave::testing::run_seed());
    CrookedCloth cloth(crooked(random, {.count = 7}), Curvature::convex);
    const Hierarchy hierarchy(rows_of_yarns(cloth.bench.fabric), places_of(cloth.bench.fabric));
    REQUIRE(hierarchy.levels().size() > 3);
    const std::vector<double> load = cloth.random_load(random);
    std::vector<std::vector<double>> steps;
    for (const CrewKind kind : every_crew) {
        DeviceMultigrid<float> device(kind, cloth, hierarchy);
        device.factor();
        CHECK(device.grown > 0);
        const int grown = device.grown;
        device.factor();
        CHECK(device.grown == grown);
        device.apply(load, steps.emplace_back());
    }
    CHECK(farthest(steps[1], steps[0]) < 1e-6);
    CHECK(farthest(steps[2], steps[0]) < 1e-6);
}

TEST_CASE("pieces: symmetric and positive, for matrices that curve down too", "[device]") {
    Random random(weave::testing::run_seed());
    INFO("WEAVE_SEED=" << weave::testing::run_seed());
    for (const bool down : {false, true}) {
        CrookedCloth cloth(crooked(random, {.count = 5}), down ? Curvature::exact : Curvature::convex);
        if (down) {
            for (std::size_t row = 0; row < cloth.matrix.rows(); row += 5) cloth.matrix.value(cloth.matrix.diagonal(row))[4] -= 100;
            cloth.upload();
        }
        const Hierarchy hierarchy(rows_of_yarns(cloth.bench.fabric), places_of(cloth.bench.fabric));
        DeviceMultigrid<double> device(CrewKind::alone, cloth, hierarchy);
        device.factor();
        const auto size = static_cast<Eigen::Index>(3 * cloth.matrix.rows());
        Eigen::MatrixXd whole(size, size);
        for (Eigen::Index i = 0; i < size; ++i) {
            std::vector<double> unit(static_cast<std::size_t>(size), 0.0), column;
            unit[static_cast<std::size_t>(i)] = 1;
            device.apply(unit, column);
            whole.col(i) = Eigen::Map<const Eigen::VectorXd>(column.data(), size);
        }
        CHECK((whole - whole.transpose()).cwiseAbs().maxCoeff() < 1e-10 * whole.cwiseAbs().maxCoeff());
        const Eigen::LLT<Eigen::MatrixXd> positive(whole + whole.transpose());
        CHECK(positive.info() == Eigen::Success);
    }
}

TEST_CASE("pieces: with few last rows conjugate gradients need hardly more steps than with the processor's", "[device]") {
    Random random(weave::testing::run_seed());
    INFO("WEAVE_SEED=" << weave::testing::run_seed());
    CrookedCloth cloth(crooked(random, {.count = 16}), Curvature::convex);
    const std::vector<YarnRows> yarns = rows_of_yarns(cloth.bench.fabric);
    const RowPlaces places = places_of(cloth.bench.fabric);
    Multigrid right(cloth.bench.executor, yarns, places);
    right.factor(cloth.matrix);
    DeviceMultigrid<float> device(CrewKind::alone, cloth, Hierarchy(yarns, places));
    device.factor();
    const std::vector<double> load = cloth.random_load(random);
    std::vector<double> x;
    const CgResult usual = conjugate_gradients(cloth.bench.executor, cloth.matrix, right, load, 1e-3, 1000, x),
                   few = conjugate_gradients(cloth.bench.executor, cloth.matrix, device, load, 1e-3, 1000, x);
    CHECK(few.relative <= 1e-3);
    CHECK(10 * few.iterations < 12 * usual.iterations + 20);
}

TEST_CASE("pieces: cloth without rows has an empty step", "[device]") {
    CrookedCloth cloth(SimScene{}, Curvature::convex);
    DeviceMultigrid<float> device(CrewKind::emulated, cloth, Hierarchy({}));
    device.factor();
    std::vector<double> step;
    device.apply({}, step);
    CHECK(step.empty());
}
