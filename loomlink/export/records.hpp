#pragma once

#include <loomlink/export/hook_plan.hpp>
#include <string>

namespace weave::loomlink {

/// Where the bit of each hook lies within the bytes of one pick, after areas, permutation and bit order of
/// the profile.
struct RecordLayout {
    std::size_t bytes = 0;                 ///< of the hooks of one pick
    std::vector<std::size_t> bit_of_hook;  ///< 8 * byte + value, where the bit counts 1 << value
};

/// Errors: areas that do not add up to the hooks, a permutation that is none.
Result<RecordLayout> record_layout(const LoomProfile& profile);

/// The picks one after the other: function bytes, then hooks. The last pick comes first where the profile
/// says so. Bits that belong to no hook are down.
std::string records(const HookPlan& plan, const LoomProfile& profile, const RecordLayout& layout);

}  // namespace weave::loomlink
