#pragma once

#include <weave/block/flip.hpp>
#include <weave/core/colour.hpp>
#include <weave/core/json.hpp>
#include <weave/core/result.hpp>
#include <weave/curve/cloth_curves.hpp>
#include <weave/design/scene.hpp>
#include <weave/sim/plan.hpp>
#include <weave/sim/simulate.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

// What studio, simd and loomlink say to one another beside frames. PROTOCOL.md has every message with its members;
// the names here are those there. Numbers of sessions, jobs, steps, frames and events are at most most_number
// (frame.hpp); picks, ends and yarns count from 0, but in reports, which people read.

namespace weave::wire {

/// The version of the protocol that is spoken here.
inline constexpr std::uint64_t protocol_version = 1;
/// No text message from a client is longer, nor one from the server.
inline constexpr std::size_t most_client_bytes = std::size_t{16} << 20;
inline constexpr std::size_t most_server_bytes = std::size_t{4} << 20;

/// What of a design is simulated, and how. Where yarns are held, what pushes on them and how rims behave says the
/// design's scene.
struct Simulation {
    sim::SimulationRequest plan;
    sim::Solver solver = sim::Solver::relax;
    std::optional<double> residual;            ///< instead of the fidelity's
    std::optional<std::uint64_t> most_steps;   ///< of the whole run
    std::optional<double> most_seconds;        ///< the same
    std::optional<sim::Fidelity> start_from;   ///< relaxed first and shown; rougher than the fidelity
};

// ---- What changes in a running session ----

/// Strain, stiffness and radii, as a design's scene has them; what is absent stays as it is. At least one is there.
struct Parameters {
    SystemScene warp, weft;
};
/// Takes the place of all yarns that were held.
struct Pins {
    std::vector<Pin> pins;
};
/// Takes the place of all fields.
struct Fields {
    std::vector<ForceField> fields;
};
/// A crossing of the whole cloth to be led to its other side.
using Change = std::variant<Parameters, Pins, Fields, Flip>;

// ---- From a client. `request` is an id of its choice: 8 to 64 of a-z, 0-9, '.', '-' and '_' ----

/// The first message, in this form in every version.
struct Hello {
    std::vector<std::uint64_t> versions;  ///< that the client speaks
    std::string client;                   ///< who it is, such as `weave 0.1`; at most 100 bytes
};
/// A new session, attached to this connection, paused at its start.
struct Create {
    std::string request;
    std::string document;  ///< text of a .weave document
    Simulation simulation;
};
/// An earlier session, attached to this connection.
struct Attach {
    std::string request;
    std::uint64_t session = 1;
    std::uint64_t seq = 0;    ///< last event that the client has
    std::uint64_t frame = 0;  ///< last frame that the client has
};
/// On until at rest.
struct Run {
    std::string request;
    std::uint64_t session = 1;
};
struct Pause {
    std::string request;
    std::uint64_t session = 1;
};
/// So many steps, then paused.
struct Step {
    std::string request;
    std::uint64_t session = 1, steps = 1;
};
struct MakeChange {
    std::string request;
    std::uint64_t session = 1;
    Change change;
};
struct ReadState {
    std::string request;
    std::uint64_t session = 1;
};
/// Answered once the state is on disk.
struct Checkpoint {
    std::string request;
    std::uint64_t session = 1;
};
struct Close {
    std::string request;
    std::uint64_t session = 1;
};
/// Events up to this one have been dealt with. Not answered.
struct Acknowledge {
    std::uint64_t session = 1, seq = 1;
};
/// How often the client wants frames at most; 0: never.
struct WantFrames {
    std::string request;
    std::uint64_t session = 1;
    double most_per_second = 30;
};
/// A job, queued durably.
struct Submit {
    std::string request;
    std::string document;
    Simulation simulation;
    std::vector<Flip> flips;  ///< made one after the other once the cloth is at rest
};
struct ListJobs {
    std::string request;
};
struct Cancel {
    std::string request;
    std::uint64_t job = 1;
};
/// The job's end has been dealt with. Not answered.
struct AcknowledgeJob {
    std::uint64_t job = 1;
};
struct ListSessions {
    std::string request;
};

using ClientMessage = std::variant<Hello, Create, Attach, Run, Pause, Step, MakeChange, ReadState, Checkpoint, Close,
                                   Acknowledge, WantFrames, Submit, ListJobs, Cancel, AcknowledgeJob, ListSessions>;

// ---- From the server: answers ----

/// The answer to Hello, in this form in every version.
struct Welcome {
    std::uint64_t version = protocol_version;  ///< that both speak from here on
    std::string server;                        ///< such as `simd 0.1.0`
    std::optional<std::string> person;         ///< as whom the client is known
};
/// There is no version that both speak; in this form in every version. The connection ends.
struct Unsupported {
    std::vector<std::uint64_t> versions;  ///< that the server speaks
};
/// It will be done, or is.
struct Accepted {
    std::string request;
    std::optional<std::uint64_t> session, job;  ///< that was made
    std::optional<double> wait_s;               ///< expected until it begins
};
struct Refused {
    std::optional<std::string> request;  ///< none where the message could not be read so far
    Error error;
    std::optional<double> wait_s;  ///< where it may be granted later: expected until then
};

enum class Phase : std::uint8_t { running, paused, at_rest };

struct State {
    std::string request;
    std::uint64_t session = 1;
    Phase phase = Phase::paused;
    std::uint64_t step = 0, seq = 0, frame = 0, layout = 0;  ///< steps made; last event, frame and layout (0: none)
    double residual = 0;
    std::optional<std::uint64_t> lost_crossings;
};

enum class JobPhase : std::uint8_t { waiting, running, done, failed, cancelled };

struct JobState {
    std::uint64_t job = 1;
    JobPhase phase = JobPhase::waiting;
    std::string title;  ///< of the design
    std::uint64_t step = 0;
    std::optional<double> residual;
    std::optional<std::uint64_t> lost_crossings;  ///< of a running one: out of order; none: not looked up
    std::optional<double> left_s;                 ///< estimated until its end
    std::optional<std::uint64_t> place;  ///< of a waiting one in the queue; 1: the next to begin
    std::optional<double> wait_s;        ///< of a waiting one: expected until it begins
    std::optional<std::string> batch;    ///< of one that the server has given to a batch system: where it is there, for people
};
struct JobList {
    std::string request;
    std::vector<JobState> jobs;
    bool signs = false;  ///< whether what a job finds is signed
};

/// A session as a list has it.
struct SessionSummary {
    std::uint64_t session = 1;
    std::string title;  ///< of the design
    Phase phase = Phase::paused;  ///< of one that has ended: its last
    std::uint64_t step = 0;
    std::optional<double> residual;  ///< none: nothing was computed yet
    std::uint64_t points = 1;        ///< control points of a frame
    std::uint64_t attached = 0;      ///< connections now
    bool ended = false;
    std::optional<double> left_s;  ///< while nobody is attached: until it is ended, or one that has ended is forgotten
};
struct SessionList {
    std::string request;
    std::vector<SessionSummary> sessions;
};

// ---- From the server: what is told unasked, and not kept ----

struct JobProgress {
    JobState state;
};
/// Told at every connection until it is acknowledged.
struct JobEnded {
    std::uint64_t job = 1;
    JobPhase phase = JobPhase::done;  ///< done, failed or cancelled
    std::optional<Error> error;       ///< of a failed one
    Json report = Json::object();     ///< as `weave simulate --json` has it; empty where there is none
    std::optional<Json> evidence;     ///< of a done one, where the server has a key: the signed document that the server hands out
};
/// Frames that this connection will not bring.
struct Gap {
    std::uint64_t session = 1, first = 1, last = 1;
};

// ---- From the server: events of a session, which are never lost. `seq` counts them from 1 ----

/// One yarn of a layout.
struct LayoutYarn {
    System system = System::warp;
    std::uint64_t number = 0;  ///< the end, or the (first) pick, in the whole cloth
    std::uint64_t beam = 0;    ///< of a warp yarn
    double radius_mm = 1;
    Colour colour;
    std::uint64_t points = 1;       ///< control points in each frame
    bool is_periodic = false;
    std::array<std::uint64_t, 2> turns{};  ///< periods along x and y from its end to its next beginning
};
/// What the yarns of the frames are that name this layout.
struct Layout {
    std::uint64_t session = 1, seq = 1, layout = 1;
    sim::Fidelity fidelity = sim::Fidelity::standard;
    std::array<bool, 2> is_periodic{};
    std::array<std::uint64_t, 2> repeats{1, 1};  ///< how often the simulated piece fills the cloth, along x and y
    std::vector<LayoutYarn> yarns;
};
struct PhaseChanged {
    std::uint64_t session = 1, seq = 1, step = 0;
    Phase phase = Phase::running;
};
/// A change took effect before the next step.
struct Applied {
    std::uint64_t session = 1, seq = 1, step = 0;
    std::string request;  ///< of the message that asked for it
    Change change;
    std::optional<Error> error;  ///< where the cloth does not take it: then nothing has changed
};
/// How a flip ended.
struct Flipped {
    std::uint64_t session = 1, seq = 1, step = 0;
    std::string request;
    bool done = true;
    std::string reason;  ///< where it is not done
};
struct Checkpointed {
    std::uint64_t session = 1, seq = 1, step = 0;  ///< step of the state that was written
    std::optional<std::string> request;  ///< none: made unasked
};
/// After a fault the session goes on from a checkpoint; changes since then are repeated at their steps, and events that
/// were told already are not told again.
struct Recovered {
    std::uint64_t session = 1, seq = 1, step = 0;
    std::uint64_t frame = 0;  ///< the last before the fault; the next has a higher number and an earlier step
};

enum class Why : std::uint8_t { closed, failed, expired };

/// The last event of a session.
struct Ended {
    std::uint64_t session = 1, seq = 1, step = 0;
    Why why = Why::closed;
    std::optional<Error> error;    ///< of a failed one
    Json report = Json::object();  ///< as `weave simulate --json` has it; empty where there is none
};

using ServerMessage = std::variant<Welcome, Unsupported, Accepted, Refused, State, JobList, JobProgress, JobEnded, Gap,
                                   Layout, PhaseChanged, Applied, Flipped, Checkpointed, Recovered, Ended, SessionList>;

/// A message as its canonical JSON (RFC 8785). Its members must be such as are read again, numbers finite; text that
/// is no UTF-8 appears with escapes.
std::string write_message(const ClientMessage& message);
std::string write_message(const ServerMessage& message);

/// The message that a text is: strict JSON, no member that PROTOCOL.md does not name. Every byte may be hostile.
/// Errors: what is wrong, and where, such as `simulation.region.first_row`.
Result<ClientMessage> read_client_message(std::string_view text);
Result<ServerMessage> read_server_message(std::string_view text);

/// The id of a request, so far as it can be found in a text that is no message; for its refusal.
std::optional<std::string> request_of(std::string_view text);

}  // namespace weave::wire
