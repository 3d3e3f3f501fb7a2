#include <weave/core/json_reader.hpp>

#include <algorithm>
#include <cmath>
#include <loomlink/keys/members.hpp>
#include <loomlink/workflow/evidence.hpp>

namespace weave::loomlink {

namespace {

constexpr const char* format = "weave-evidence";
constexpr std::size_t hash_characters = 64, most_regions = 64;
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
    const double coverage =
        statement.regions.empty() ? 1 : covered_share(statement.regions, statement.picks, statement.ends);
    return {{"format", format},
            {"version", 1},
            {"site", statement.site},
            {"at", statement.at},
            {"design_sha256", hash_hex(statement.design_sha256)},
            {"scene_sha256", hash_hex(statement.scene_sha256)},
            {"report_sha256", hash_hex(statement.report_sha256)},
            {"picks", statement.picks},
            {"ends", statement.ends},
            {"regions", std::move(regions)},
            {"coverage", coverage},
            {"fidelity", statement.fidelity},
            {"parameters", statement.parameters},
            {"solver", statement.solver},
            {"residual", statement.residual ? Json(*statement.residual) : Json(nullptr)},
            {"converged", statement.converged},
            {"order_kept", statement.order_kept}};
}

Result<SimulationStatement> read_simulation(const Json& body) {
    constexpr std::size_t most_parameters = 65536;
    constexpr double equal_shares = 1e-9;
    JsonReader reader(body, "statement");
    read_heading(reader, format);
    SimulationStatement statement;
    statement.site = name_member(reader, "site");
    statement.at = utc_text(utc_member(reader, "at"));
    statement.design_sha256 = hash_member(reader, "design_sha256");
    statement.scene_sha256 = hash_member(reader, "scene_sha256");
    statement.report_sha256 = hash_member(reader, "report_sha256");
    statement.picks = size_member(reader, "picks", 1, most_lines);
    statement.ends = size_member(reader, "ends", 1, most_lines);
    if (!reader.failed()) read_regions(reader, statement);
    const double coverage = reader.number("coverage", {0, 1});
    statement.fidelity = reader.text("fidelity", {}, 32);
    statement.parameters = reader.raw("parameters");
    statement.solver = name_member(reader, "solver");
    const Json& residual = reader.raw("residual");
    if (residual.is_number()) statement.residual = residual.get<double>();
    if (!residual.is_number() && !residual.is_null()) reader.fail("must be a number or null", "residual");
    statement.converged = reader.boolean("converged");
    statement.order_kept = reader.boolean("order_kept");
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    if (!statement.parameters.is_object() || canonical_json(statement.parameters).size() > most_parameters)
        return bad_input("must be an object of at most 64 KiB", "statement.parameters");
    if (rank_of_fidelity(statement.fidelity) < 0)
        return bad_input("must be draft, standard or reference", "statement.fidelity");
    const double share =
        statement.regions.empty() ? 1 : covered_share(statement.regions, statement.picks, statement.ends);
    if (std::abs(share - coverage) > equal_shares)
        return bad_input("is not the share that the regions cover", "statement.coverage");
    return statement;
}

}  // namespace weave::loomlink
