#pragma once

#include <weave/curve/cloth_curves.hpp>
#include <weave/design/design.hpp>
#include <weave/sim/scene.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace weave::sim {

/// How finely yarns are resolved, and how still they must be.
enum class Fidelity : std::uint8_t {
    draft,      ///< 2 control points a crossing, residual 1e-2: for editing
    standard,   ///< 4, residual 1e-3
    reference,  ///< 8, twice as many contact samples, residual 1e-8
};

Result<Fidelity> parse_fidelity(std::string_view text);
std::string_view name_of(Fidelity fidelity);
/// The residual that a fidelity asks for where nobody says otherwise.
double goal_of(Fidelity fidelity);

/// Target strain of the ends where a scene does not say: the paper's.
inline constexpr double usual_strain = 1.01;

/// What to simulate of a design, and how finely. What is absent follows from the design and the fidelity.
struct SimulationRequest {
    Fidelity fidelity = Fidelity::standard;
    std::optional<Region> region;
    std::optional<WeftMode> weft_mode;
    std::optional<double> points_per_key;  ///< control points per key point of a yarn
    std::optional<double> sample_spacing;  ///< see SimScene
    bool reduce = true;  ///< a periodic cloth is simulated as its smallest repeat
    std::vector<std::array<std::size_t, 2>> held;  ///< crossings held at their planned place: pick and end, from 0
    /// The period in x or y is unknown, and the piece pulled apart there with so much force for each mm of rim.
    std::array<std::optional<double>, 2> relaxing_N_per_mm{};
};

/// One thing that the plan does or saves, and why.
struct PlanLine {
    std::string term;    ///< such as `repeat`, `friction`, `radii`
    std::string choice;  ///< such as `off`, `1 of 16 repeats`
    std::string reason;
};

/// What is simulated of a design: the scene that solvers see, and where it came from.
struct Plan {
    SimScene scene;
    ClothCurves curves;  ///< of what is simulated: one repeat, a region, or the whole
    std::vector<std::size_t> curve_of;           ///< of each simulated yarn its index in `curves`
    std::array<std::size_t, 2> repeats{1, 1};    ///< how often the simulated repeat fills the cloth, in x and y
    std::size_t cloth_rows = 0, cloth_columns = 0;  ///< of the whole design
    std::size_t cloth_picks = 0, cloth_ends = 0;    ///< of the whole design
    /// Where the period relaxes: the force that pulls the whole rim, N.
    std::array<std::optional<double>, 2> rim_force_N{};
    std::vector<PlanLine> lines;
    Fidelity fidelity = Fidelity::standard;
    double points_per_key = 0;
    double goal = 0;  ///< residual
};

/// The lines of a plan as `plan[]` of `weave simulate --json`: term, choice, reason.
Json lines_json(const Plan& plan);

/// Derives the plan from a design's scene. Errors: nothing to simulate; yarns fed at constant tension whose ends are
/// free, or whose period relaxes without a force, which would shrink for ever; a period that relaxes where there is none;
/// a crossing to hold that is not there; a region outside the cloth; overrides out of range.
Result<Plan> make_plan(const Design& design, const Block& block, const SimulationRequest& request);

}  // namespace weave::sim
