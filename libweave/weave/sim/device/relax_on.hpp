#pragma once

#include <weave/sim/device/relaxing_cloth.hpp>
#include <weave/sim/spread.hpp>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace weave::sim {

// A `Machine` has a `Crew`, a `memory()`, and
//   run(kernel, numbers, items)    kernel(crew, numbers) by its crew, which mostly works on so many items; each thread has numbers of its
//                                  own that begin alike, and those of one of them come back.
// One that can relax many cloths next to one another also has a `BlockCrew`, smaller than its crew, and
//   run_each(kernels, numbers)     kernels[k](crew, numbers[k]) for every k, each by a crew of its own.

/// Leads a cloth to its end, by the crew of a machine.
template <class Real, class Machine>
void lead(Machine& machine, RelaxingCloth<Real, typename Machine::Crew>& cloth) {
    while (!cloth.is_over()) {
        cloth.begin_leg();
        machine.run(cloth.kernel(), cloth.leg(), cloth.items());
        cloth.end_leg();
    }
}

/// Leads cloths to their ends, each by a crew of its own.
template <class Real, class Machine>
void lead_each(Machine& machine, std::vector<RelaxingCloth<Real, typename Machine::BlockCrew>*> cloths) {
    using Cloth = RelaxingCloth<Real, typename Machine::BlockCrew>;
    while (std::erase_if(cloths, [](const Cloth* cloth) { return cloth->is_over(); }), !cloths.empty()) {
        std::vector<RunLeg<Real>> kernels;
        std::vector<typename Cloth::OwnLeg> legs;
        for (Cloth* cloth : cloths) {
            cloth->begin_leg();
            kernels.push_back(cloth->kernel());
            legs.push_back(cloth->leg());
        }
        machine.run_each(kernels, legs);
        for (std::size_t k = 0; k < cloths.size(); ++k) {
            cloths[k]->leg() = legs[k];
            cloths[k]->end_leg();
        }
    }
}

/// relax() (relax.hpp) by the crew of a machine, with forces in `Real`. Of the scene device_can_relax() (relax_device.hpp) must hold. Throws std::bad_alloc where the
/// machine's memory does not suffice; the state is then what it was, or one on the way.
template <class Real, class Machine>
RelaxResult relax_on(Machine& machine, Energy<double>& energy, std::vector<double>& state, const RelaxOptions& options) {
    spread_points(energy, state);
    RelaxingCloth<Real, typename Machine::Crew> cloth(machine.memory(), energy, state, options);
    lead<Real>(machine, cloth);
    return cloth.result();
}

/// The same for cloths next to one another. Whoever watches one of them ends that one.
template <class Real, class Machine>
std::vector<RelaxResult> relax_each_on(Machine& machine, std::span<const ClothToRelax> cloths) {
    using Cloth = RelaxingCloth<Real, typename Machine::BlockCrew>;
    std::vector<std::unique_ptr<Cloth>> all;
    std::vector<Cloth*> led;
    for (const ClothToRelax& cloth : cloths) {
        spread_points(*cloth.energy, *cloth.state);
        all.push_back(std::make_unique<Cloth>(machine.memory(), *cloth.energy, *cloth.state, cloth.options));
        led.push_back(all.back().get());
    }
    lead_each<Real>(machine, std::move(led));
    std::vector<RelaxResult> results;
    for (const auto& cloth : all) results.push_back(cloth->result());
    return results;
}

}  // namespace weave::sim
