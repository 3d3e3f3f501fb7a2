#pragma once

#include <weave/core/colour.hpp>
#include <weave/core/result.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace weave {

/// No sequence has more elements before it repeats.
inline constexpr std::size_t longest_sequence = std::size_t{1} << 22;

/// A list that repeats for ever: element i is `once[i mod size]`. In files it is text with runs: `0*12 1
/// 0*12`.
struct Sequence {
    std::vector<std::uint32_t> once{0};
    [[nodiscard]] std::uint32_t at(std::size_t i) const { return once[i % once.size()]; }
    friend bool operator==(const Sequence&, const Sequence&) = default;
};

/// Reads `0*12 1 0*12`: numbers below `below`, each with an optional count. At least one, at most 2^22
/// elements.
Result<Sequence> parse_sequence(std::string_view text, std::uint32_t below);
std::string to_text(const Sequence& sequence);

/// A kind of yarn with what simulation, pictures and consumption need to know of it.
struct YarnType {
    std::string name;
    Colour colour;
    double radius_mm = 0.15;
    double linear_density_tex = 50;
    double stretch_stiffness_N = 100;       ///< EA
    double bending_stiffness_N_mm2 = 0.01;  ///< EI
    double contact_stiffness_N_mm2 = 1;     ///< k of the contact energy
    friend bool operator==(const YarnType&, const YarnType&) = default;
};

/// A beam or creel group: ends that are fed, and take up, together.
struct Beam {
    std::string name;
    friend bool operator==(const Beam&, const Beam&) = default;
};

/// The warp as it is set up: which yarn each end is and from which beam it comes.
struct WarpPlan {
    std::vector<YarnType> yarns;  ///< never empty
    Sequence order;               ///< for each end the index of its yarn type
    std::vector<Beam> beams;      ///< never empty
    Sequence beam_order;          ///< for each end the index of its beam
    Sequence colour_order;        ///< for each end 0 (its yarn's own colour) or k (colours[k-1])
    std::vector<Colour> colours;
    double density_ends_per_cm = 20;
    std::uint32_t ends_per_dent = 2;
    friend bool operator==(const WarpPlan&, const WarpPlan&) = default;
};

/// A weft supply: a shuttle, or a cone on a feeder.
struct Feeder {
    std::string name;
    std::uint32_t yarn = 0;  ///< index into WeftPlan::yarns
    friend bool operator==(const Feeder&, const Feeder&) = default;
};

/// Which way a pick is inserted.
enum class Direction : std::uint8_t { left_to_right, right_to_left };

/// The feeders of one pick: none (cloth is only taken up), one, or two.
using FeederSet = std::vector<std::uint32_t>;

/// The weft as it is inserted. Every list repeats over the picks of the design.
struct WeftPlan {
    std::vector<YarnType> yarns;               ///< never empty
    std::vector<Feeder> feeders;               ///< never empty, at most 64
    std::vector<FeederSet> feeder_order{{0}};  ///< for each pick its feeders, as indices into `feeders`
    /// For each pick its direction; empty: each feeder goes back and forth, the first time from the left.
    std::vector<Direction> directions;
    /// For each pick whether the cloth advances after it; empty: after the last pick of each row of the
    /// block, so that the picks of a row come to lie on top of each other.
    std::vector<bool> take_up;
    double density_picks_per_cm = 20;  ///< rows of the block per centimetre of cloth
    friend bool operator==(const WeftPlan&, const WeftPlan&) = default;
};

/// Sensible yarns, one kind a system, for a design that says nothing.
WarpPlan default_warp();
WeftPlan default_weft();

}  // namespace weave
