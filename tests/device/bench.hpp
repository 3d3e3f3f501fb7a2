#pragma once

// A scene on the processor and in the arrays of the device's solver, in the memory of a machine of support/machines.hpp, so that
// both can be asked the same.

#include "support/told.hpp"

#include <weave/sim/device/cloth_arrays.hpp>
#include <weave/sim/device/forces.hpp>
#include <weave/sim/device/lists_arrays.hpp>
#include <weave/sim/device/safe.hpp>

#include <sim/scenes.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace weave::sim::testing {

/// What a crew that made lists goes on with, and whether there was room for all of them.
struct ListsTold {
    ListsState state;
    bool done;
};

template <class Real>
struct UpdateLists {
    ClothView<Real> cloth;
    ListsRoom<Real> room;
    ListsState before;
    View<const double> at;
    View<ListsTold> told;

    template <class Crew>
    WEAVE_HD void operator()(Crew& crew) const {
        Lists<Real> lists(cloth, room, before);
        const bool done = lists.update(crew, at);
        crew.alone(device_tests::TellIt<ListsTold>{told, {lists.state(), done}});
    }
};

/// A scene on the processor and in the memory of a machine.
template <class Real, class Machine>
struct DeviceBench {
    Machine& machine;
    Bench<double> host;
    ClothArrays<Real> arrays;
    ClothView<Real> cloth;
    ListsArrays<Real> lists;
    ListsState lists_state;
    Array<ListsTold> told;
    Array<double> state;
    Array<ContactSum<Real>> contact;
    Array<double> energy, share;
    Array<Real> by_segment, gradient, change;
    Array<Moved<Real>> moved;

    DeviceBench(Machine& on, const SimScene& scene)
        : machine(on), host(scene), arrays(on.memory, host.fabric, host.state), cloth(arrays.view()), lists(on.memory, cloth, host.energy.first_weights(host.state)),
          told(on.memory, 1), state(on.memory, host.state), contact(on.memory, cloth.samples), energy(on.memory, cloth.segments),
          share(on.memory, cloth.segments), by_segment(on.memory, 12 * std::size_t(cloth.segments)),
          gradient(on.memory, 3 * std::size_t(cloth.rows)), change(on.memory, 3 * std::size_t(cloth.rows)),
          moved(on.memory, cloth.samples) {}

    [[nodiscard]] ForcesRoom<Real> forces() const { return {contact.view(), energy.view(), by_segment.view()}; }
    [[nodiscard]] SafeSteps<Real> safe() const { return {cloth, moved.view(), share.view()}; }
    [[nodiscard]] View<const double> at() const { return state.view(); }

    /// Lists made once by the machine, from what was before, with so much room.
    ListsTold update(const ListsRoom<Real>& room, const ListsState& before) {
        machine.run(UpdateLists<Real>{cloth, room, before, at(), told.view()});
        return told.get().front();
    }
    /// Lists made by the machine, with room made where it lacks.
    ListsView<Real> listed() {
        for (;;) {
            const ListsTold made = update(lists.room(), lists_state);
            lists_state = made.state;
            if (made.done) return Lists<Real>(cloth, lists.room(), lists_state).view();
            lists.grow(lists_state);
        }
    }

    /// Numbers of the rows of a vector of slots.
    [[nodiscard]] std::vector<Real> rows_of(const std::vector<double>& slots) const {
        std::vector<Real> rows;
        for (std::size_t slot = 0; slot < host.fabric.slots(); ++slot) {
            if (host.fabric.moves()[slot] == 0) continue;
            for (std::size_t k = 0; k < 3; ++k) rows.push_back(static_cast<Real>(slots[3 * slot + k]));
        }
        return rows;
    }
    /// And back, with the slots that follow.
    [[nodiscard]] std::vector<double> slots_of(const std::vector<Real>& rows) const {
        std::vector<double> slots(3 * host.fabric.slots(), 0);
        std::size_t row = 0;
        for (std::size_t slot = 0; slot < host.fabric.slots(); ++slot) {
            if (host.fabric.moves()[slot] == 0) continue;
            for (std::size_t k = 0; k < 3; ++k) slots[3 * slot + k] = static_cast<double>(rows[3 * row + k]);
            ++row;
        }
        host.fabric.follow_change(slots);
        return slots;
    }
};

/// What the device must be able to relax, by name.
struct NamedScene {
    std::string name;
    SimScene scene;
    double rounding = 1;  ///< how much more of it there is than near the origin
};

inline SimScene with_held_parts(SimScene scene) {
    for (SimYarn& yarn : scene.yarns) {
        yarn.frozen.assign(yarn.control.size(), 0);
        yarn.frozen.front() = 1;
        if (&yarn == &scene.yarns.front()) yarn.frozen.assign(yarn.control.size(), 1);
    }
    return scene;
}

inline std::vector<NamedScene> every_scene() {
    Random random(7);
    std::vector<NamedScene> all;
    all.push_back({"nothing", {}});
    all.push_back({"heap", heap(random, 6)});
    all.push_back({"heap of thin and thick", heap(random, 8, 0.004)});
    all.push_back({"plain weave", plain_weave({})});
    all.push_back({"small plain weave", plain_weave({.count = 2, .points_a_crossing = 2, .pitch_mm = 0.3})});
    all.push_back({"larger plain weave", plain_weave({.count = 8})});
    for (SimYarn& yarn : all.back().scene.yarns) shake(random, yarn, 0.02);
    all.push_back({"held parts", with_held_parts(plain_weave({.count = 4}))});
    SimScene far = plain_weave({.count = 4});
    for (SimYarn& yarn : far.yarns) {
        for (Vec3& point : yarn.control) point += Vec3(1e6, -2e6, 5e5) * 0.25;
    }
    all.push_back({"far from the origin", far, 100});
    SimScene pushed = plain_weave({.count = 4});
    pushed.fields.push_back({.centre_mm = {1, 1, 0.1}, .radius_mm = 0.7, .strength_N_per_mm = 2});
    pushed.gravity_mm_ms2 = 9.81e-3;
    for (SimYarn& yarn : pushed.yarns) yarn.gram_per_mm = 1e-4;
    all.push_back({"fields and weight", pushed});
    return all;
}

}  // namespace weave::sim::testing
