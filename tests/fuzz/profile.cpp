// A loom profile from anywhere: refused with a reason, or one whose hooks add up.
#include "support/must.hpp"

#include <weave/loom/profile.hpp>

#include <algorithm>

using namespace weave;
using fuzz::must;

namespace {

/// The hooks of one end lie on the loom, carry ends, and are not named twice.
void check_end(const LoomProfile& profile, const std::vector<HookUse>& uses, std::size_t end,
               std::size_t ends) {
    auto hooks = hooks_of_end(profile, end, ends);
    must(!hooks.empty(), "an end that fits has a hook");
    for (const std::size_t hook : hooks) {
        must(hook < uses.size(), "no end hangs on a hook that the loom does not have");
        must(uses[hook] == HookUse::body, "ends hang on body hooks");
    }
    std::sort(hooks.begin(), hooks.end());
    must(std::adjacent_find(hooks.begin(), hooks.end()) == hooks.end(), "an end hangs on a hook once");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto profile = read_profile(fuzz::text_of(data, size));
    if (!profile) {
        must(!profile.error().message.empty(), "a refusal says why");
        return 0;
    }
    must(profile->sha256.size() == 64, "a profile knows its hash");
    must(profile->total_hooks >= 1 && profile->total_hooks <= most_hooks, "the hooks are within bounds");
    const std::vector<HookUse> uses = hook_uses(*profile);
    must(uses.size() == profile->total_hooks, "every hook has a use");

    const std::size_t most = most_ends(*profile);
    must(most >= 1 && most <= profile->total_hooks, "a loom carries ends, no more than it has hooks");
    for (const std::size_t ends : {std::size_t{1}, most / 2, most - 1, most}) {
        if (ends == 0) continue;
        for (const std::size_t end : {std::size_t{0}, ends / 2, ends - 1})
            check_end(*profile, uses, end, ends);
    }
    must(hooks_of_end(*profile, 0, most + 1).empty(), "a design that is too wide has no hooks");
    must(hooks_of_end(*profile, most, most).empty(), "an end beyond the last has no hooks");
    for (const std::size_t at : {std::size_t{0}, std::size_t{1}, std::size_t{65535}, SIZE_MAX}) {
        static_cast<void>(selvedge_lifted(*profile, at, at));
    }
    return 0;
}
