#include "cases.hpp"
#include "cloths.hpp"
#include "stopwatch.cuh"

#include <weave/sim/device/crew_arrays.hpp>
#include <weave/sim/device/launches.cuh>

namespace weave::gpu_bench {

namespace {

using Real = float;

/// Bytes that the pass must move at least: every list once, every sample with its radius once, what comes of it once.
double least_bytes(std::size_t own, std::size_t samples, std::size_t neighbours) {
    return static_cast<double>(own) * (sizeof(std::uint32_t) + sizeof(sim::ContactSum<Real>)) +
           static_cast<double>(samples) * (sizeof(sim::Sample<Real>) + sizeof(Real)) + static_cast<double>(neighbours) * sizeof(std::uint32_t);
}

}  // namespace

Figures measure_contact() {
    Cloth cloth(sample_scene("satin-e", sim::Fidelity::standard, 36));
    sim::DeviceQueue queue;
    sim::CudaMemory memory(queue);
    sim::Launches launches(queue);
    sim::CrewArrays<Real> arrays(memory, cloth.energy, cloth.state);
    sim::CrewState made;
    for (;;) {
        const sim::CrewRoom<Real> room = arrays.room();
        sim::Lists<Real> lists(room.cloth, room.lists, made.lists);
        const bool done = lists.update(launches, sim::View<const double>(room.state));
        made.lists = lists.state();
        if (done) break;
        made.lacking = sim::Lacking::lists;
        arrays.grow(made);
    }
    const sim::CrewRoom<Real> room = arrays.room();
    const sim::ListsView<Real> view = sim::Lists<Real>(room.cloth, room.lists, made.lists).view();
    const std::size_t own = cloth.fabric.samples();
    const std::size_t neighbours = launches.read(sim::View<const std::uint32_t>(view.first), own), images = made.lists.halo;
    const sim::SampleContact<Real> pass{view, room.cloth.floor, static_cast<Real>(room.cloth.scale.step_mm), room.forces.contact};
    const Stopwatch watch(queue);
    const double ms = watch.median_ms(20, [&] { launches.each(own, pass); });
    const double bytes = least_bytes(own, own + images, neighbours);
    const std::string of = std::to_string(cloth.fabric.points()) + " points, " + std::to_string(own) + " samples, " +
                           std::to_string(neighbours) + " neighbours; median of 20";
    return {{"the pass over contact samples, float", ms, "ms", of},
            {"  its bandwidth", bytes / ms / 1e6, "GB/s", "bytes that must move: lists, samples, radii, sums, each once"}};
}

}  // namespace weave::gpu_bench
