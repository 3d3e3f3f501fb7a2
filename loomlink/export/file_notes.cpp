#include <algorithm>
#include <loomlink/export/file_parts.hpp>

namespace weave::loomlink {

void note_settings(WrittenFile& file, const HookPlan& plan, const LoomProfile& profile) {
    const auto assume = [&](bool does, const char* what) {
        if (does) file.assumed.emplace_back(what);
    };
    const bool is_raw = profile.output == OutputFormat::raw;
    const auto odd = [](const HookArea& area) { return area.hooks % 8 != 0; };
    assume(!file.names.name.empty() && file.names.name.size() < name_room,
           "a name of fewer than 8 characters is filled up with NUL");
    assume(std::any_of(profile.areas.begin(), profile.areas.end(), odd),
           "areas whose hooks are not a multiple of 8");
    assume(!profile.pick_1_at_bottom, "the record of pick 1 is the last one");
    assume(!profile.least_bit_first, "hooks of a byte count from the most significant bit");
    assume(!is_raw && !profile.lifted_is_one, "a lifted hook's bit is 0");
    assume(!is_raw && !profile.hook_permutation.empty(), "hooks stand in an order of their own");
    assume(plan.lead_in > 0, "lead-in picks before pick 1");
    assume(std::any_of(plan.feeders.begin(), plan.feeders.end(), [](const auto& f) { return f.size() > 1; }),
           "two feeders on one pick");
    assume(std::any_of(plan.feeders.begin() + static_cast<std::ptrdiff_t>(plan.lead_in), plan.feeders.end(),
                       [](const auto& f) { return f.empty(); }),
           "picks that select no feeder");
}

}  // namespace weave::loomlink
