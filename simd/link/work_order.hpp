#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>
#include <weave/wire/message.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace weave::simd {

/// A change of a session as its journal has it.
struct JournaledChange {
    std::uint64_t number = 1;  ///< in its session, from 1
    std::string request;
    wire::Change change;
    std::optional<std::uint64_t> step;  ///< before which it was made, once it was; a run taken up again makes it there again
    bool flip_told = false;             ///< how the flip ended has been told
};

/// What a worker is to do, the first message to it: a session, or a job.
struct WorkOrder {
    bool is_job = false;
    std::uint64_t number = 1;         ///< of the session or job
    std::string document;             ///< text of a .weave document, hostile
    wire::Simulation simulation;
    std::vector<Flip> flips;          ///< of a job
    std::string folder;               ///< where its checkpoint lies, and where results go
    std::string backend = "auto";     ///< what computes, by sim::parse_backend
    std::uint64_t planning_bytes = 0; ///< memory that it may take until it is admitted; 0: any
    std::uint64_t checkpoint_s = 3;   ///< seconds from one checkpoint to the next, as long as legs end
    bool takes_up = false;            ///< goes on from the checkpoint in the folder, if there is one
    std::vector<JournaledChange> changes;  ///< of a session, all that its journal has
    bool runs = false;                     ///< a session that is not paused
    std::optional<std::uint64_t> pause_at; ///< a step; else it runs to rest
    std::uint64_t frame = 0, layout = 0;   ///< numbers of the last that were given
    std::string layout_sha256;             ///< of the last one
};

Json to_json(const WorkOrder& order);
/// Errors: what no daemon writes.
Result<WorkOrder> work_order_from(const Json& json);

Json to_json(const JournaledChange& change);
Result<JournaledChange> journaled_change_from(const Json& json);

/// A simulation and the flips that follow it as text, to be kept.
std::string simulation_text(const wire::Simulation& simulation, const std::vector<Flip>& flips = {});
struct SimulationWork {
    wire::Simulation simulation;
    std::vector<Flip> flips;
};
Result<SimulationWork> simulation_from(std::string_view text);

/// Hash of what a layout says of its yarns, whatever its numbers.
std::string layout_sha256(wire::Layout layout);

/// A change as JSON, with the members that a `change` message has.
std::string change_text(const wire::Change& change);
Result<wire::Change> change_from(std::string_view text);

}  // namespace weave::simd
