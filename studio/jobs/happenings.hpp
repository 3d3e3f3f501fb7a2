#pragma once

#include <weave/block/flip.hpp>
#include <weave/sim/inspect.hpp>
#include <weave/sim/plan.hpp>
#include <weave/sim/yarns.hpp>
#include <weave/wire/frame.hpp>
#include <weave/wire/message.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace weave::studio {

/// What the yarns of the frames are, and the control points of all yarns at one step: the same, whoever
/// computes. Frames show the simulated piece; `repeats` of the layout says how often it fills the cloth.
using YarnLayout = wire::Layout;
using Frame = wire::Frame;

/// Where a run is.
enum class RunPhase : std::uint8_t {
    idle,      ///< none was begun
    planning,  ///< yarns are laid out, or the server is being asked
    running,
    paused,   ///< until somebody asks for more; also where it cannot get further
    at_rest,  ///< as still as was asked for
    failed,   ///< over; the error says why
    stopped,  ///< over, because somebody said so
};

struct ResidualPoint {
    std::uint64_t step = 0;
    double residual = 0;
};

/// How far a run has come.
struct Progress {
    std::uint64_t step = 0;
    double residual = 0, goal = 0;  ///< force that is left over the reference force, and when it is at rest
    std::optional<std::uint64_t>
        lost_crossings;                  ///< that do not lie as the card says; nothing: not looked up yet
    double seconds = 0;                  ///< since it began, without its pauses
    std::optional<double> seconds_left;  ///< estimated; nothing while the residual does not fall
    bool is_coarse = false;              ///< still in the fewer points of a rougher fidelity
    bool is_flipping = false;            ///< two yarns are just being led past one another
    std::vector<ResidualPoint> history;  ///< since it was told last, oldest first
};

/// What is modelled and why, before it begins.
struct PlanSummary {
    std::string title;
    std::size_t points = 0, yarns = 0,
                repeats = 1;           ///< of the simulated piece, and how often it fills the cloth
    std::uint64_t expected_bytes = 0;  ///< memory that it is expected to take
    std::vector<sim::PlanLine> lines;
};

struct FlipEnd {
    Flip flip;
    bool done = false;
    std::string reason;  ///< where it is not done
};
struct ParametersArrived {};
/// What was asked for is not done; the run goes on as before.
struct ChangeRefused {
    Error error;
};
/// What keeps a run from its server; empty once that is over.
struct Trouble {
    std::string words;
};
/// Yarns at rest with what a weaver wants to know of them.
struct Inspected {
    std::shared_ptr<const Yarns> yarns;
    std::shared_ptr<const Inspection> inspection;
};

/// What a computing thread tells the window of.
using Happening =
    std::variant<RunPhase, std::shared_ptr<const PlanSummary>, std::shared_ptr<const YarnLayout>,
                 std::shared_ptr<const Frame>, Progress, std::shared_ptr<const Yarns>, Inspected, FlipEnd,
                 ParametersArrived, ChangeRefused, Trouble, Error>;

}  // namespace weave::studio
