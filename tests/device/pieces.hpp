#pragma once

#include "support/machines.hpp"
#include "support/told.hpp"

#include <weave/sim/device/piece_arrays.hpp>
#include <weave/sim/device/pieces_apply.hpp>
#include <weave/sim/multigrid.hpp>

#include <sim/conjugate_gradients.hpp>
#include <sim/scenes.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace {

using namespace weave::sim;
using namespace weave::sim::testing;

template <class Real>
struct ShapePieces {
    MatrixView matrix;
    PiecesView<Real> pieces;
    View<std::uint8_t> fits;  ///< one

    template <class Crew>
    WEAVE_HD void operator()(Crew& crew) const {
        const bool has_room = shape_pieces(crew, matrix, pieces);
        crew.alone(device_tests::TellIt<std::uint8_t>{fits, has_room});
    }
};

template <class Real>
struct FactorPieces {
    MatrixView matrix;
    PiecesView<Real> pieces;

    template <class Crew>
    WEAVE_HD void operator()(Crew& crew) const {
        factor(crew, matrix, pieces);
    }
};

template <class Real>
struct ApplyPieces {
    PiecesView<Real> pieces;
    View<const Real> residual;
    View<Real> step;

    template <class Crew>
    WEAVE_HD void operator()(Crew& crew) const {
        apply(crew, pieces, residual, step);
    }
};

/// A matrix of the processor in the memory of a machine.
struct UploadedMatrix {
    Array<std::uint32_t> first, column, diagonal;
    Array<float> value;

    UploadedMatrix(Memory& memory, const BlockMatrix& matrix)
        : first(memory, matrix.rows() + 1), column(memory, matrix.blocks()), diagonal(memory, matrix.rows()),
          value(memory, 9 * matrix.blocks()) {
        std::vector<std::uint32_t> numbers(matrix.rows() + 1);
        for (std::size_t row = 0; row < matrix.rows(); ++row) numbers[row + 1] = matrix.first(row + 1);
        first.put(numbers);
        numbers.resize(matrix.rows());
        for (std::size_t row = 0; row < matrix.rows(); ++row) numbers[row] = matrix.diagonal(row);
        diagonal.put(numbers);
        numbers.resize(matrix.blocks());
        std::vector<float> values(9 * matrix.blocks());
        for (std::size_t at = 0; at < matrix.blocks(); ++at) {
            numbers[at] = matrix.column(at);
            std::copy_n(matrix.value(at), 9, &values[9 * at]);
        }
        column.put(numbers);
        value.put(values);
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
    Memory& memory;
    std::unique_ptr<UploadedMatrix> uploaded;

    CrookedCloth(Memory& in, const SimScene& scene, Curvature curvature) : bench(scene), memory(in) {
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

/// The multigrid on a machine as a preconditioner of the processor's.
template <class Real, class Machine>
struct DeviceMultigrid : Preconditioner {
    Machine& machine;
    MatrixView matrix;
    PieceArrays<Real> pieces;
    Array<std::uint8_t> fits;
    int grown = 0;

    DeviceMultigrid(Machine& on, const MatrixView& given, const Hierarchy& hierarchy)
        : machine(on), matrix(given), pieces(on.memory, hierarchy), fits(on.memory, 1) {}

    void factor() {
        while (!has_shape()) {
            REQUIRE(++grown < 20);
            pieces.grow();
        }
        machine.run(FactorPieces<Real>{matrix, pieces.view()});
    }
    bool has_shape() {
        machine.run(ShapePieces<Real>{matrix, pieces.view(), fits.view()});
        return fits.get().front() != 0;
    }

    void apply(const std::vector<double>& residual, std::vector<double>& step) override {
        const Array<Real> from(machine.memory, std::vector<Real>(residual.begin(), residual.end())), to(machine.memory, residual.size());
        machine.run(ApplyPieces<Real>{pieces.view(), from.view(), to.view()});
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

TEMPLATE_TEST_CASE("pieces: the multigrid on a device is the processor's", "[device]", WEAVE_MACHINES) {
    TestType machine;
    const std::uint64_t seed = weave::testing::run_seed();
    INFO("WEAVE_SEED=" << seed);
    Random random(seed);
    const WeaveShape small{.count = 2}, some{.count = 6}, many{.count = 20};
    for (const WeaveShape& shape : {small, some, many}) {
        for (const bool is_held : {false, true}) {
            for (const Curvature curvature : {Curvature::convex, Curvature::exact}) {
                CrookedCloth cloth(machine.memory, crooked(random, shape, is_held), curvature);
                for (const bool grids : {false, true}) {
                    const RowPlaces places = grids ? places_of(cloth.bench.fabric) : RowPlaces{};
                    const Hierarchy hierarchy(rows_of_yarns(cloth.bench.fabric), places);
                    Multigrid right(cloth.bench.executor, rows_of_yarns(cloth.bench.fabric), places);
                    right.factor(cloth.matrix);
                    const std::vector<double> load = cloth.random_load(random);
                    std::vector<double> step, same;
                    right.apply(load, step);
                    INFO("points " << shape.count << ", held " << is_held << ", grids " << grids);
                    DeviceMultigrid<double, TestType> device(machine, cloth.uploaded->view(), hierarchy);
                    device.factor();
                    device.apply(load, same);
                    CHECK(farthest(same, step) < 1e-6);  // measured over 40 seeds: 1.4e-7
                    DeviceMultigrid<float, TestType> in_float(machine, cloth.uploaded->view(), hierarchy);
                    in_float.factor();
                    in_float.apply(load, same);
                    CHECK(farthest(same, step) < 5e-6);  // 5.1e-7
                }
            }
        }
    }
}

TEMPLATE_TEST_CASE("pieces: every time the same step, and that of one thread but for the order of sums", "[device]", WEAVE_MACHINES) {
    Random random(weave::testing::run_seed());
    INFO("WEAVE_SEED=" << weave::testing::run_seed());
    TestType machine;
    CrookedCloth cloth(machine.memory, crooked(random, {.count = 7}), Curvature::convex);
    const Hierarchy hierarchy(rows_of_yarns(cloth.bench.fabric), places_of(cloth.bench.fabric));
    REQUIRE(hierarchy.levels().size() > 3);
    const std::vector<double> load = cloth.random_load(random);
    DeviceMultigrid<float, TestType> device(machine, cloth.uploaded->view(), hierarchy);
    std::vector<double> step, again, right;
    device.factor();
    CHECK(device.grown > 0);
    const int grown = device.grown;
    device.apply(load, step);
    device.factor();
    CHECK(device.grown == grown);
    device.apply(load, again);
    CHECK(again == step);
    device_tests::OneThread one_thread;
    const UploadedMatrix matrix(one_thread.memory, cloth.matrix);
    DeviceMultigrid<float, device_tests::OneThread> alone(one_thread, matrix.view(), hierarchy);
    alone.factor();
    alone.apply(load, right);
    CHECK(farthest(step, right) < 1e-6);
}

namespace {

/// Whether a symmetric matrix is positive: all pivots of its elimination are. (By hand, for nvcc does not compile Eigen's.)
bool is_positive(std::vector<std::vector<double>> matrix) {
    for (std::size_t pivot = 0; pivot < matrix.size(); ++pivot) {
        if (!(matrix[pivot][pivot] > 0)) return false;
        for (std::size_t i = pivot + 1; i < matrix.size(); ++i) {
            const double share = matrix[pivot][i] / matrix[pivot][pivot];
            for (std::size_t j = i; j < matrix.size(); ++j) matrix[i][j] -= share * matrix[pivot][j];
        }
    }
    return true;
}

}  // namespace

TEMPLATE_TEST_CASE("pieces: symmetric and positive, for matrices that curve down too", "[device]", WEAVE_MACHINES) {
    TestType machine;
    Random random(weave::testing::run_seed());
    INFO("WEAVE_SEED=" << weave::testing::run_seed());
    for (const bool down : {false, true}) {
        CrookedCloth cloth(machine.memory, crooked(random, {.count = 5}), down ? Curvature::exact : Curvature::convex);
        if (down) {
            for (std::size_t row = 0; row < cloth.matrix.rows(); row += 5) cloth.matrix.value(cloth.matrix.diagonal(row))[4] -= 100;
            cloth.upload();
        }
        const Hierarchy hierarchy(rows_of_yarns(cloth.bench.fabric), places_of(cloth.bench.fabric));
        DeviceMultigrid<double, TestType> device(machine, cloth.uploaded->view(), hierarchy);
        device.factor();
        std::vector<std::vector<double>> columns(3 * cloth.matrix.rows());
        for (std::size_t i = 0; i < columns.size(); ++i) {
            std::vector<double> unit(columns.size(), 0.0);
            unit[i] = 1;
            device.apply(unit, columns[i]);
        }
        double most = 0, differs = 0;
        for (std::size_t i = 0; i < columns.size(); ++i) {
            for (std::size_t j = 0; j < columns.size(); ++j) {
                most = std::max(most, std::abs(columns[i][j]));
                differs = std::max(differs, std::abs(columns[i][j] - columns[j][i]));
            }
        }
        CHECK(differs < 1e-10 * most);
        CHECK(is_positive(columns));
    }
}

TEMPLATE_TEST_CASE("pieces: with few last rows conjugate gradients need hardly more steps than with the processor's", "[device]", WEAVE_MACHINES) {
    TestType machine;
    Random random(weave::testing::run_seed());
    INFO("WEAVE_SEED=" << weave::testing::run_seed());
    CrookedCloth cloth(machine.memory, crooked(random, {.count = 16}), Curvature::convex);
    const std::vector<YarnRows> yarns = rows_of_yarns(cloth.bench.fabric);
    const RowPlaces places = places_of(cloth.bench.fabric);
    Multigrid right(cloth.bench.executor, yarns, places);
    right.factor(cloth.matrix);
    DeviceMultigrid<float, TestType> device(machine, cloth.uploaded->view(), Hierarchy(yarns, places));
    device.factor();
    const std::vector<double> load = cloth.random_load(random);
    std::vector<double> x;
    const CgResult usual = conjugate_gradients(cloth.bench.executor, cloth.matrix, right, load, 1e-3, 1000, x),
                   few = conjugate_gradients(cloth.bench.executor, cloth.matrix, device, load, 1e-3, 1000, x);
    CHECK(few.relative <= 1e-3);
    CHECK(10 * few.iterations < 12 * usual.iterations + 20);
}

TEMPLATE_TEST_CASE("pieces: cloth without rows has an empty step", "[device]", WEAVE_MACHINES) {
    TestType machine;
    CrookedCloth cloth(machine.memory, SimScene{}, Curvature::convex);
    DeviceMultigrid<float, TestType> device(machine, cloth.uploaded->view(), Hierarchy({}));
    device.factor();
    std::vector<double> step;
    device.apply({}, step);
    CHECK(step.empty());
}
