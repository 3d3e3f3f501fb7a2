#pragma once

#include <weave/ranks/split_cloth.hpp>
#include <weave/sim/plan_in_stretches.hpp>
#include <weave/sim/yarns.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace weave::ranks {

/// What is kept of a plan, once it is dealt out, for the file of its yarns: what is known of each yarn, and the crossings of
/// this rank's blocks.
struct Outline {
    Yarns bare;                   ///< without points and crossings
    std::vector<double> per_key;  ///< of each yarn, control points from one key point to the next
    struct Own {
        Crossing crossing;           ///< of the yarns that are simulated
        std::uint64_t number = 0;    ///< among all crossings
        std::size_t block = 0;       ///< of those of this rank
    };
    std::vector<Own> crossings;
    std::uint64_t all_crossings = 0, planned_crossings = 0;  ///< the latter with those of yarns that are not simulated
    sim::Plan plan;                                          ///< without points and key points
    std::vector<std::size_t> keys;                           ///< of each yarn
    Json coverage, lines;
    sim::Fidelity fidelity = sim::Fidelity::standard;
    double points_per_key = 0, goal = 0;
};
Outline outline_of(const Design& design, const sim::PlanInStretches& plan, const std::vector<Part>& parts);

/// What is measured on yarns at rest, the same on all ranks.
struct Measured {
    std::vector<double> length_mm;  ///< of each yarn
    std::size_t contacts = 0;
    double max_overlap = 0;
    std::array<double, 2> strain_deviation{};  ///< of warps and of wefts
    std::size_t lost = 0, slid = 0;            ///< crossings
};
Measured measure(Comm& comm, const Cut& cut, const std::vector<Part>& parts, const Outline& outline, SplitCloth& cloth);

/// Writes the yarns of all ranks to one file, through the first rank, which holds the numbers of one block at a time.
Status write_split(Comm& comm, const Design& design, const Cut& cut, const std::vector<Part>& parts, const Outline& outline, const Measured& measured,
                   SplitCloth& cloth, Json report, const std::filesystem::path& out);

}  // namespace weave::ranks
