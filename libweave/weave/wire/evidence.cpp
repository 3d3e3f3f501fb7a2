#include <weave/wire/evidence.hpp>

#include <weave/core/json_reader.hpp>
#include <weave/keys/members.hpp>
#include <weave/sim/plan.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace weave::wire {

namespace {

constexpr const char* format = "weave-evidence";
constexpr std::size_t hash_characters = 64, most_regions = 64, most_choices = 128, longest_word = 4096;
constexpr std::int64_t most_lines = std::int64_t{1} << 24;

Hash hash_member(JsonReader& reader, const std::string& key) {
    return parse_hash(hex_member(reader, key, hash_characters)).value_or(Hash{});
}

std::size_t size_member(JsonReader& reader, const std::string& key, std::int64_t low, std::int64_t high) {
    return static_cast<std::size_t>(reader.integer(key, low, std::max(low, high)));
}

void read_regions(JsonReader& reader, SimulationStatement& statement) {
    auto entries = reader.objects("regions");
    if (entries.size() > most_regions) return reader.fail("has more than 64 regions", "regions");
    const auto picks = static_cast<std::int64_t>(statement.picks);
    const auto ends = static_cast<std::int64_t>(statement.ends);
    for (JsonReader& entry : entries) {
        SimulatedRegion region;
        region.first_pick = size_member(entry, "first_pick", 0, picks - 1);
        region.first_end = size_member(entry, "first_end", 0, ends - 1);
        region.picks = size_member(entry, "picks", 1, picks - static_cast<std::int64_t>(region.first_pick));
        region.ends = size_member(entry, "ends", 1, ends - static_cast<std::int64_t>(region.first_end));
        entry.no_others();
        statement.regions.push_back(region);
    }
}

/// The lines of a plan, in a statement as in a report.
std::vector<StatedChoice> read_plan(JsonReader& reader) {
    auto entries = reader.objects("plan");
    if (entries.size() > most_choices) reader.fail("has more than 128 lines", "plan");
    std::vector<StatedChoice> plan;
    for (JsonReader& entry : entries) {
        if (reader.failed()) break;
        StatedChoice line{entry.text("term", {}, longest_word), entry.text("choice", {}, longest_word),
                          entry.text("reason", {}, longest_word)};
        entry.no_others();
        plan.push_back(std::move(line));
    }
    return plan;
}

Json plan_json(const std::vector<StatedChoice>& plan) {
    Json lines = Json::array();
    for (const StatedChoice& line : plan)
        lines.push_back({{"term", line.term}, {"choice", line.choice}, {"reason", line.reason}});
    return lines;
}

std::string fidelity_member(JsonReader& reader) {
    std::string text = reader.text("fidelity", {}, 32);
    if (!reader.failed() && !sim::parse_fidelity(text)) reader.fail("must be draft, standard or reference", "fidelity");
    return text;
}

/// The members that a report tells in the same words as a statement.
void read_outcome(JsonReader& reader, SimulationStatement& statement) {
    statement.design_sha256 = hash_member(reader, "design_sha256");
    statement.scene_sha256 = hash_member(reader, "scene_sha256");
    statement.fidelity = fidelity_member(reader);
    statement.plan = read_plan(reader);
    const Json& residual = reader.raw("residual");  // null where it was not finite
    if (residual.is_number()) statement.residual = residual.get<double>();
    if (!residual.is_number() && !residual.is_null()) reader.fail("must be a number or null", "residual");
    statement.converged = reader.boolean("converged");
    statement.order_kept = reader.boolean("order_kept");
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

double share_of(const SimulationStatement& statement) {
    return statement.regions.empty() ? 1 : covered_share(statement.regions, statement.picks, statement.ends);
}

}  // namespace

double covered_share(const std::vector<SimulatedRegion>& regions, std::size_t picks, std::size_t ends) {
    std::vector<std::size_t> cuts{0, picks};
    for (const SimulatedRegion& region : regions) {
        cuts.push_back(region.first_pick);
        cuts.push_back(region.first_pick + region.picks);
    }
    std::sort(cuts.begin(), cuts.end());
    double covered = 0;
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        std::vector<std::pair<std::size_t, std::size_t>> spans;  // of ends, within this band of picks
        for (const SimulatedRegion& region : regions)
            if (region.first_pick <= cuts[k] && cuts[k + 1] <= region.first_pick + region.picks)
                spans.emplace_back(region.first_end, region.first_end + region.ends);
        std::sort(spans.begin(), spans.end());
        std::size_t wide = 0, reached = 0;
        for (const auto& [from, to] : spans) {
            if (to > reached) wide += to - std::max(from, reached);
            reached = std::max(reached, to);
        }
        covered += static_cast<double>(cuts[k + 1] - cuts[k]) * static_cast<double>(wide);
    }
    return covered / (static_cast<double>(picks) * static_cast<double>(ends));
}

Json statement_body(const SimulationStatement& statement) {
    Json regions = Json::array();
    for (const SimulatedRegion& region : statement.regions)
        regions.push_back({{"first_pick", region.first_pick},
                           {"picks", region.picks},
                           {"first_end", region.first_end},
                           {"ends", region.ends}});
    return {{"format", format},
            {"version", 1},
            {"site", statement.site},
            {"at", statement.at},
            {"design_sha256", hash_hex(statement.design_sha256)},
            {"scene_sha256", hash_hex(statement.scene_sha256)},
            {"report_sha256", hash_hex(statement.report_sha256)},
            {"result_sha256", hash_hex(statement.result_sha256)},
            {"picks", statement.picks},
            {"ends", statement.ends},
            {"regions", std::move(regions)},
            {"coverage", share_of(statement)},
            {"fidelity", statement.fidelity},
            {"plan", plan_json(statement.plan)},
            {"parameters", statement.parameters},
            {"solver", statement.solver},
            {"residual", statement.residual ? Json(*statement.residual) : Json(nullptr)},
            {"converged", statement.converged},
            {"order_kept", statement.order_kept}};
}

Result<SimulationStatement> read_simulation(const Json& body) {
    constexpr double equal_shares = 1e-9;
    JsonReader reader(body, "statement");
    read_heading(reader, format);
    SimulationStatement statement;
    statement.site = name_member(reader, "site");
    statement.at = utc_text(utc_member(reader, "at"));
    read_outcome(reader, statement);
    statement.report_sha256 = hash_member(reader, "report_sha256");
    statement.result_sha256 = hash_member(reader, "result_sha256");
    statement.picks = size_member(reader, "picks", 1, most_lines);
    statement.ends = size_member(reader, "ends", 1, most_lines);
    if (!reader.failed()) read_regions(reader, statement);
    const double coverage = reader.number("coverage", {0, 1});
    statement.parameters = reader.raw("parameters");
    if (!statement.parameters.is_object()) reader.fail("must be an object", "parameters");
    statement.solver = name_member(reader, "solver");
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    if (std::abs(share_of(statement) - coverage) > equal_shares)
        return bad_input("is not the share that the regions cover", "statement.coverage");
    if (canonical_json(body).size() > most_statement) return bad_input("has more than 64 KiB", "statement");
    return statement;
}

Result<SimulationStatement> statement_of_result(std::string_view report, Instant at) {
    if (report.size() > most_report) return bad_input("has more than 4 MiB");
    WEAVE_TRY(const Json json, parse_json(report));
    JsonReader reader(json, "");
    SimulationStatement statement;
    read_outcome(reader, statement);
    statement.report_sha256 = sha256(report);
    statement.result_sha256 = hash_member(reader, "yarns_sha256");
    read_coverage(reader.object("coverage"), statement);
    statement.solver = "weave " WEAVE_VERSION ", " + reader.text("solver", {}, 32);
    statement.at = utc_text(at);
    WEAVE_CHECK_OK(reader.status());
    statement.parameters = parameters_of(json);
    return statement;
}

}  // namespace weave::wire
