#include <loomlink/workflow/policy.hpp>

#include <weave/core/json_reader.hpp>

namespace weave::loomlink {

namespace {

constexpr std::int64_t most_people = 16, most_hours = 168;
const std::vector<std::string> fidelities{"draft", "standard", "reference"};

}  // namespace

Json to_json(const SitePolicy& policy) {
    return {{"approvals", policy.approvals},
            {"release_signatures", policy.release_signatures},
            {"simulation", policy.simulation_required ? "required" : "optional"},
            {"fidelity", policy.fidelity},
            {"coverage", policy.coverage},
            {"index_valid_hours", policy.index_valid_hours}};
}

Result<SitePolicy> read_policy(const Json& json) {
    JsonReader reader(json, "policy");
    SitePolicy policy;
    policy.approvals = static_cast<std::size_t>(reader.integer("approvals", 1, most_people));
    policy.release_signatures =
        static_cast<std::size_t>(reader.integer("release_signatures", 1, most_people));
    policy.simulation_required = reader.choice("simulation", {"required", "optional"}) == 0;
    policy.fidelity = fidelities[reader.choice("fidelity", fidelities)];
    policy.coverage = reader.number("coverage", {0, 1});
    policy.index_valid_hours = static_cast<std::size_t>(reader.integer("index_valid_hours", 1, most_hours));
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    return policy;
}

Result<SitePolicy> policy_in_force(const Reader& reader) {
    WEAVE_TRY(const auto paper, reader.policy());
    if (!paper) return SitePolicy{};
    WEAVE_TRY(const Json json, parse_json(paper->text));
    return read_policy(json);
}

int rank_of_fidelity(std::string_view fidelity) {
    for (std::size_t k = 0; k < fidelities.size(); ++k)
        if (fidelities[k] == fidelity) return static_cast<int>(k);
    return -1;
}

}  // namespace weave::loomlink
