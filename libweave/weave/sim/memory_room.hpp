#pragma once

#include <weave/sim/plan.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace weave::sim {

/// What a simulation takes, as far as memory goes.
struct MemoryNeed {
    std::size_t points = 0;  ///< control points of its yarns
    Fidelity fidelity = Fidelity::standard;
    double points_per_key = 0;     ///< see SimScene
    double points_in_a_stack = 0;  ///< where they are densest, rather too many than too few
    double picks_in_a_row = 0, ends_in_a_column = 0;  ///< on average
    std::uint64_t copied_bytes = 0;                    ///< see forecast.hpp
    std::array<std::size_t, 2> picks_and_ends{};       ///< of one repeat, where that alone is simulated
};

MemoryNeed need_of(const Plan& plan);
/// The need of a plan that is not made yet, by the key points that its yarns will have (ClothLayout::foreseen): what need_of() that
/// plan says, within a few in a hundred, in a tenth of the time. Nothing where the smallest repeat of the cloth may do, which only the
/// plan finds, and where it will find an error.
std::optional<MemoryNeed> foreseen_need(const Design& design, const Block& block,
                                        const SimulationRequest& request);

/// Memory that simulations may take somewhere.
struct MemoryRoom {
    std::uint64_t bytes = 0;
    std::string server;  ///< its name; empty: this computer
};

/// What is free here, and what a limit on the address space of this process leaves of it; nothing where the system does not say.
std::optional<MemoryRoom> room_here();

/// An error where the room is not expected to do, with both amounts and what would have room.
Status check_room(const MemoryNeed& need, const MemoryRoom& room);

}  // namespace weave::sim
