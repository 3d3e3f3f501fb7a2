#include <weave/core/json_reader.hpp>

#include <algorithm>
#include <loomlink/commands/simulation_result.hpp>
#include <loomlink/keys/members.hpp>
#include <utility>

namespace weave::loomlink {

namespace {

constexpr std::size_t hash_characters = 64;
constexpr std::int64_t most_lines = std::int64_t{1} << 24;

Hash hash_member(JsonReader& reader, const std::string& key) {
    return parse_hash(hex_member(reader, key, hash_characters)).value_or(Hash{});
}

/// `[first, last]` of picks or ends, from 1, as first and how many from 0.
std::pair<std::size_t, std::size_t> span_of(JsonReader& coverage, const std::string& key, std::size_t of) {
    const auto ends = coverage.integers(key, 1, static_cast<std::int64_t>(std::max<std::size_t>(of, 1)));
    if (!coverage.failed() && (ends.size() != 2 || ends[0] > ends[1]))
        coverage.fail("must be the first and the last", key);
    if (coverage.failed()) return {0, 1};
    return {static_cast<std::size_t>(ends[0] - 1), static_cast<std::size_t>(ends[1] - ends[0] + 1)};
}

void read_coverage(JsonReader coverage, SimulationStatement& statement) {
    JsonReader of = coverage.object("of");
    statement.picks = static_cast<std::size_t>(of.integer("picks", 1, most_lines));
    statement.ends = static_cast<std::size_t>(of.integer("ends", 1, most_lines));
    const bool is_whole = coverage.boolean("whole");
    const bool has_spans = !is_whole || coverage.has("picks") || coverage.has("ends");
    if (coverage.failed() || !has_spans) return;
    const auto [first_pick, picks] = span_of(coverage, "picks", statement.picks);
    const auto [first_end, ends] = span_of(coverage, "ends", statement.ends);
    if (!is_whole)
        statement.regions.push_back({first_pick, picks, first_end, ends});
    else if (!coverage.failed() && (picks != statement.picks || ends != statement.ends))
        coverage.fail("is said to be whole, but names a part", "whole");
}

/// What the result owes to beside design and scene: those of its members that say how it was computed.
Json parameters_of(const Json& report) {
    Json parameters = Json::object();
    for (const char* member : {"solver", "backend", "points_per_key", "goal", "ending", "iterations",
                               "evaluations", "max_overlap", "lost_crossings", "slid_crossings", "friction"})
        if (report.contains(member)) parameters[member] = report.at(member);
    return parameters;
}

}  // namespace

Result<SimulationStatement> statement_of_result(std::string_view report) {
    WEAVE_TRY(const Json json, parse_json(report));
    JsonReader reader(json, "");
    SimulationStatement statement;
    statement.design_sha256 = hash_member(reader, "design_sha256");
    statement.scene_sha256 = hash_member(reader, "scene_sha256");
    statement.report_sha256 = sha256(report);
    read_coverage(reader.object("coverage"), statement);
    statement.fidelity = reader.text("fidelity", {}, 32);
    statement.solver = "weave " WEAVE_VERSION ", " + reader.text("solver", {}, 32);
    const Json& residual = reader.raw("residual");  // null where it was not finite
    if (residual.is_number()) statement.residual = residual.get<double>();
    statement.converged = reader.boolean("converged");
    statement.order_kept = reader.boolean("order_kept");
    statement.at = utc_text(system_clock()());
    WEAVE_CHECK_OK(reader.status());
    statement.parameters = parameters_of(json);
    return statement;
}

}  // namespace weave::loomlink
