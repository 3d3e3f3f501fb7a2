#include <loomlink/workflow/missing.hpp>

#include <weave/core/text.hpp>

#include <algorithm>

namespace weave::loomlink {

Result<std::string> why_stale(const Reader& reader, const Validation& validation) {
    WEAVE_TRY(const auto loom, reader.loom(validation.loom));
    if (!loom) return system_fault("the store is damaged: a loom is missing");
    WEAVE_TRY(const auto versions, reader.profiles(loom->id));
    if (versions.empty() || versions.back().version == validation.profile_version) return std::string();
    return "the profile of the loom is of version " + std::to_string(versions.back().version) +
           " now, it was " + std::to_string(validation.profile_version);
}

Result<std::vector<std::string>> missing_evidence(const Reader& reader, const Design& design,
                                                  const Revision& revision, const SitePolicy& policy) {
    WEAVE_TRY(const auto simulations, simulations_of(reader, revision));
    auto missing = missing_simulation(simulations, revision, policy);
    WEAVE_TRY(const auto validations, validations_of(reader, design, revision));
    WEAVE_TRY(const auto waived, waivers_with_looms(reader, revision.id));
    for (const Validation& validation : validations) {
        WEAVE_TRY(const std::string stale, why_stale(reader, validation));
        if (!stale.empty())
            missing.push_back("a new validation for the loom " + validation.loom + ": " + stale);
        for (std::string& text : open_errors(validation, waived)) missing.push_back(std::move(text));
    }
    return missing;
}

Result<std::size_t> approvals_of(const Reader& reader, Id revision) {
    WEAVE_TRY(const auto decisions, reader.decisions(revision));
    return static_cast<std::size_t>(
        std::count_if(decisions.begin(), decisions.end(),
                      [](const Decision& decision) { return decision.kind == DecisionKind::approve; }));
}

Result<std::vector<std::string>> missing_for_release(const Reader& reader, const Design& design,
                                                     const Revision& revision) {
    WEAVE_TRY(const SitePolicy policy, policy_in_force(reader));
    switch (revision.state) {
        case RevisionState::released:
            return std::vector<std::string>();
        case RevisionState::changes_requested:
            return std::vector<std::string>{"changes were requested: save them as a new revision"};
        case RevisionState::superseded:
        case RevisionState::withdrawn:
            return std::vector<std::string>{std::string("it is ") + word(revision.state) +
                                            ": only a new revision can be released"};
        case RevisionState::approved:
            return std::vector<std::string>{"a release to a loom"};
        case RevisionState::draft:
        case RevisionState::submitted:
            break;
    }
    std::vector<std::string> missing;
    if (revision.state == RevisionState::draft) missing.emplace_back("it is not submitted yet");
    WEAVE_TRY(auto evidence, missing_evidence(reader, design, revision, policy));
    for (std::string& text : evidence) missing.push_back(std::move(text));
    WEAVE_TRY(const std::size_t approvals, approvals_of(reader, revision.id));
    if (approvals < policy.approvals)
        missing.push_back(counted(policy.approvals - approvals, "approval") +
                          " of somebody who did not work on it");
    return missing;
}

}  // namespace weave::loomlink
