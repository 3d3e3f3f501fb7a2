// policy: what the site asks for before anything goes to a loom.

#include <weave/core/text.hpp>

#include <algorithm>
#include <charconv>
#include <loomlink/commands/client_command.hpp>

namespace weave::loomlink {

namespace {

struct PolicyWish {
    std::optional<std::int64_t> approvals, release_signatures, index_valid_hours;
    std::string simulation, fidelity;
    std::optional<double> coverage;
};

/// The policy in force with what was given put in its place; nothing where nothing was given.
std::optional<Json> changed(Json policy, const PolicyWish& wish) {
    const Json before = policy;
    if (wish.approvals) policy["approvals"] = *wish.approvals;
    if (wish.release_signatures) policy["release_signatures"] = *wish.release_signatures;
    if (!wish.simulation.empty()) policy["simulation"] = wish.simulation;
    if (!wish.fidelity.empty()) policy["fidelity"] = wish.fidelity;
    if (wish.coverage) policy["coverage"] = *wish.coverage;
    if (wish.index_valid_hours) policy["index_valid_hours"] = *wish.index_valid_hours;
    if (policy == before) return {};
    return policy;
}

/// What the policy asks for that the people of now cannot give. It is in force all the same: they may join later.
Status warn_if_nobody_can(wire::MillClient& client, const Json& policy, CommandOutcome& outcome) {
    WEAVE_TRY(const Json people, client.get("/people"));
    const auto is_approver = [](const Json& person) {
        const Json& roles = person.at("roles");
        return person.at("active") == true && std::find(roles.begin(), roles.end(), "approver") != roles.end();
    };
    const auto approvers = std::count_if(people.at("people").begin(), people.at("people").end(), is_approver);
    const auto warn = [&](const char* member, const char* deed) {
        const auto asked = policy.at(member).get<std::int64_t>();
        if (asked <= approvers) return;
        outcome.note("Nothing can be " + std::string(deed) + " until more join: the policy asks for " +
                     counted(asked, "approver") + ", and there " + (approvers == 1 ? "is " : "are ") +
                     std::to_string(approvers));
    };
    warn("approvals", "approved");
    warn("release_signatures", "released");
    return {};
}

Status tell_policy(wire::MillClient& client, const PolicyWish& wish, CommandOutcome& outcome) {
    WEAVE_TRY(Json policy, client.get("/policy"));
    if (const auto wanted = changed(policy, wish)) {
        WEAVE_TRY(policy, client.change("PUT", "/policy", *wanted));
        WEAVE_CHECK_OK(warn_if_nobody_can(client, policy, outcome));
    }
    std::vector<std::vector<std::string>> lines;
    for (const auto& [name, value] : policy.items()) lines.push_back({name, told(policy, name)});
    outcome.answer(policy, in_columns(lines));
    return {};
}

/// Why a word is no share of a cloth; empty where it is one.
std::string not_a_share(std::string& word) {
    double share = -1;
    const char* const end = word.data() + word.size();
    const bool is_number = std::from_chars(word.data(), end, share).ptr == end;
    return is_number && share >= 0 && share <= 1 ? "" : "'" + on_one_line(word) + "' is no share from 0 to 1";
}

}  // namespace

void add_policy_command(CLI::App& app, CommandOutcome& outcome) {
    const auto command = add_client_command(app, outcome, "policy",
                                            "Tell the policy of the site, or put what is given in force",
                                            "loomlink policy --approvals 2 --simulation optional");
    const auto wish = std::make_shared<PolicyWish>();
    add_number(command.command, "--approvals", wish->approvals, "different people who must approve");
    add_number(command.command, "--release-signatures", wish->release_signatures,
               "different people who must sign a release; a new trust document is due then");
    command.command->add_option("--simulation", wish->simulation, "required or optional")
        ->check(one_of({"required", "optional"}))
        ->type_name("WORD");
    command.command
        ->add_option("--fidelity", wish->fidelity, "the least that counts: draft, standard, reference")
        ->check(one_of({"draft", "standard", "reference"}))
        ->type_name("WORD");
    command.command
        ->add_option("--coverage", wish->coverage, "least share of the crossings that is simulated, 0 to 1")
        ->check(CLI::Validator(not_a_share, ""))
        ->type_name("SHARE");
    add_number(command.command, "--index-valid-hours", wish->index_valid_hours,
               "how long a loom may go on with its last index");
    on_client_run(command, outcome,
                  [wish, &outcome](wire::MillClient& client) { return tell_policy(client, *wish, outcome); });
}

}  // namespace weave::loomlink
