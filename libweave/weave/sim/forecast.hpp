#pragma once

#include <weave/sim/plan.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

namespace weave::sim {

/// Control points of all yarns that a plan simulates.
std::size_t points_of(const Plan& plan);

/// Memory that a cloth of so many control points is expected to take while it relaxes, bytes. Measured:
/// 980,000 points took 5.7 kB each at their most (docs/simulation.md), 115,200 of a plain weave 4.6 kB, small ones some
/// 30 MiB in all; but 56,249 and 333,711 points of parts of the shoe, whose many layers begin close together, 11 to
/// 13.6 kB.
std::uint64_t expected_bytes(std::size_t points);
/// Memory in which a smallest repeat becomes the whole cloth again (copied_back()), and that cloth a file, bytes; 0 where all of it is
/// simulated. It comes once the repeat is at rest.
std::uint64_t copied_bytes(const Plan& plan);
/// Memory that a plan is expected to take from its first step to its file, bytes.
std::uint64_t expected_bytes(const Plan& plan);
/// The most points that are expected to take so many bytes; 0 where none does.
std::size_t points_within(std::uint64_t bytes);

/// An amount of memory for people, such as `3.1 GiB`.
std::string memory_text(std::uint64_t bytes);

}  // namespace weave::sim
