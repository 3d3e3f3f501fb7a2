#include <simd/link/work_order.hpp>

#include <weave/core/sha256.hpp>

#include <utility>
#include <variant>

namespace weave::simd {

namespace {

/// An id for messages that go through no connection.
constexpr const char* no_request = "no-request";

template <class Kind>
Result<Kind> message_of(std::string_view text) {
    WEAVE_TRY(wire::ClientMessage message, wire::read_client_message(text));
    if (auto* kind = std::get_if<Kind>(&message)) return std::move(*kind);
    return bad_input("is another message than was expected");
}

}  // namespace

std::string change_text(const wire::Change& change) {
    return wire::write_message(wire::MakeChange{no_request, 1, change});
}

Result<wire::Change> change_from(std::string_view text) {
    WEAVE_TRY(wire::MakeChange make, message_of<wire::MakeChange>(text));
    return std::move(make.change);
}

std::string simulation_text(const wire::Simulation& simulation, const std::vector<Flip>& flips) {
    return wire::write_message(wire::Submit{no_request, "", simulation, flips});
}

Result<SimulationWork> simulation_from(std::string_view text) {
    WEAVE_TRY(wire::Submit work, message_of<wire::Submit>(text));
    return SimulationWork{std::move(work.simulation), std::move(work.flips)};
}

std::string layout_sha256(wire::Layout layout) {
    layout.session = layout.seq = layout.layout = 1;
    return sha256_hex(wire::write_message(wire::ServerMessage(std::move(layout))));
}

Json to_json(const JournaledChange& change) {
    return {{"number", change.number},
            {"request", change.request},
            {"change", change_text(change.change)},
            {"step", change.step ? Json(*change.step) : Json()},
            {"flip_told", change.flip_told}};
}

Result<JournaledChange> journaled_change_from(const Json& json) {
    JournaledChange change;
    change.number = json.at("number");
    change.request = json.at("request");
    WEAVE_TRY(change.change, change_from(json.at("change").get<std::string>()));
    if (!json.at("step").is_null()) change.step = json.at("step").get<std::uint64_t>();
    change.flip_told = json.at("flip_told");
    return change;
}

Json to_json(const WorkOrder& order) {
    Json changes = Json::array();
    for (const JournaledChange& change : order.changes) changes.push_back(to_json(change));
    return {{"is_job", order.is_job},
            {"number", order.number},
            {"work", wire::write_message(wire::Submit{no_request, order.document, order.simulation, order.flips})},
            {"folder", order.folder},
            {"backend", order.backend},
            {"planning_bytes", order.planning_bytes},
            {"checkpoint_s", order.checkpoint_s},
            {"takes_up", order.takes_up},
            {"changes", std::move(changes)},
            {"runs", order.runs},
            {"pause_at", order.pause_at ? Json(*order.pause_at) : Json()},
            {"frame", order.frame},
            {"layout", order.layout},
            {"layout_sha256", order.layout_sha256}};
}

Result<WorkOrder> work_order_from(const Json& json) {
    WorkOrder order;
    order.is_job = json.at("is_job");
    order.number = json.at("number");
    WEAVE_TRY(wire::Submit work, message_of<wire::Submit>(json.at("work").get<std::string>()));
    order.document = std::move(work.document);
    order.simulation = std::move(work.simulation);
    order.flips = std::move(work.flips);
    order.folder = json.at("folder");
    order.backend = json.at("backend");
    order.planning_bytes = json.at("planning_bytes");
    order.checkpoint_s = json.at("checkpoint_s");
    order.takes_up = json.at("takes_up");
    for (const Json& change : json.at("changes")) {
        WEAVE_TRY(JournaledChange journaled, journaled_change_from(change));
        order.changes.push_back(std::move(journaled));
    }
    order.runs = json.at("runs");
    if (!json.at("pause_at").is_null()) order.pause_at = json.at("pause_at").get<std::uint64_t>();
    order.frame = json.at("frame");
    order.layout = json.at("layout");
    order.layout_sha256 = json.at("layout_sha256");
    return order;
}

}  // namespace weave::simd
