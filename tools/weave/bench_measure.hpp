#pragma once

#include <weave/block/block.hpp>
#include <weave/core/json.hpp>
#include <weave/design/design.hpp>
#include <weave/sim/paper.hpp>
#include <weave/sim/simulate.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

// What the benchmarks of the simulator share.
namespace weave::program {

/// The residuals whose times are told.
inline constexpr std::array<double, 5> told_residuals{1e-1, 1e-2, 1e-3, 1e-5, 1e-8};

/// Processor, cores, memory, and the threads that are used.
Json machine_json(std::size_t threads);
/// The same in words.
std::string machine_line(const Json& machine);

/// Seconds from anywhere: the processor's where one thread computes, so that what runs beside it hardly
/// counts; else the clock's on the wall.
double seconds_now(std::size_t threads);

/// The greatest memory of the process since reset_peak_memory(), in bytes; 0 where the system does not say.
std::uint64_t peak_memory();
void reset_peak_memory();

/// Length of a centreline, mm.
double length_of(const Spline& spline);

/// Control points of every yarn.
using Control = std::vector<std::vector<Vec3>>;
std::size_t points_of(const sim::SimScene& scene);

/// One state of a plan's yarns as a weaver measures it.
struct Shape {
    std::vector<Spline> splines;  ///< one a yarn of the scene
    std::array<double, 2>
        crimp_pc{};           ///< mean over the warps, over the wefts: length over planned length less 1, %
    double thickness_mm = 0;  ///< from the lowest to the highest place of any yarn
    std::size_t lost = 0;     ///< crossings that do not lie as the card says
};
Shape shape_of(const sim::Plan& plan, const Control& control);

/// Of `shape` against `right`: crimp in percentage points, thickness in mm and %, places in radii.
Json error_json(const sim::Plan& plan, const Shape& shape, const Shape& right);

/// How far a run may go.
struct RunLimits {
    double residual = 1e-8, seconds = 300;
    std::size_t threads = 0;
};

/// The state at the first time that a residual of told_residuals was reached.
struct Snapshot {
    double wanted = 0, residual = 0, seconds = 0, energy = 0;
    std::size_t iterations = 0;
    Control control;
};

struct Measured {
    sim::RelaxResult result;
    std::vector<Snapshot> snapshots;  ///< as many of told_residuals as were reached
    Control control;                  ///< the last state
    std::size_t points = 0, samples = 0;
    std::uint64_t peak_bytes = 0;
    double cap_seconds = 0;

    /// When a residual was reached.
    [[nodiscard]] std::optional<double> seconds_to(double residual) const;
    /// How it ran: points, samples, steps, seconds to each residual, memory.
    [[nodiscard]] Json json() const;
};

/// Relaxes a plan, from its own start or another, and looks on: at each of told_residuals the state is kept,
/// its residual measured anew with the reference force of that very state. Looking is not counted as time;
/// seconds, and their limit, are those of seconds_now().
Measured measure(const sim::Plan& plan, sim::Solver solver, const sim::PaperOptions& paper,
                 const RunLimits& limits, const Control* start = nullptr);

/// The same curves with `times` as many segments (exact), or with as many control points as those of `scene`.
Control refined(const sim::SimScene& scene, const Control& control, std::size_t times);
Control resampled_to(const sim::SimScene& scene, const sim::SimScene& from, const Control& control);

/// A design as it is measured.
struct Structure {
    std::string name;
    Design design;
    BlockPtr block;
    std::array<std::size_t, 2> tiles{1, 1};  ///< side by side, unreduced; 1, 1: reduced to the smallest repeat
};

/// Every sample, and a plain weave of pinned yarns.
std::vector<std::string> structure_names();
/// The shoes: a hundred thousand points and more, measured only where they are asked for by name.
bool is_whole_product(const std::string& name);
/// One of them: as its smallest repeat, as `weave simulate` takes it, but for the pinned yarns, which are 4 x 4 of theirs.
Result<Structure> make_structure(const std::string& name);

/// Options of `weave bench` that all its parts have.
struct BenchOptions {
    std::string folder;
    std::vector<std::string> only;
    double seconds = 300;
    std::size_t threads = 0;
};

/// Tells on standard error how far it has come; a residual or time that was not reached is a dash.
void tell(const std::string& line);
std::string in_words(const char* format, double number);

}  // namespace weave::program
