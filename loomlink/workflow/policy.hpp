#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>

#include <cstddef>
#include <loomlink/store/reader.hpp>
#include <string>
#include <string_view>

namespace weave::loomlink {

/// What a site asks for before anything goes to a loom; README.md has the members.
struct SitePolicy {
    std::size_t approvals = 1;           ///< different people who must approve, 1 to 16
    std::size_t release_signatures = 1;  ///< different people who must sign a release, 1 to 16
    bool simulation_required = true;
    std::string fidelity = "standard";  ///< the least that counts
    double coverage = 0;  ///< least share of the crossings that simulations together cover, 0 to 1
    std::size_t index_valid_hours = 24;  ///< 1 to 168
};

Json to_json(const SitePolicy& policy);
/// All members must be there. Errors name the member.
Result<SitePolicy> read_policy(const Json& json);
/// The policy in force; the default one where none was set.
Result<SitePolicy> policy_in_force(const Reader& reader);

/// 0 for `draft`, 1 for `standard`, 2 for `reference`; -1 for other words.
int rank_of_fidelity(std::string_view fidelity);

}  // namespace weave::loomlink
