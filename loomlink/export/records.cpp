#include <loomlink/export/records.hpp>

namespace weave::loomlink {

namespace {

/// Where the bit of each place, in the order of the areas, lies.
std::vector<std::size_t> bits_of_places(const LoomProfile& profile, std::size_t& next) {
    std::vector<std::size_t> bits;
    for (const HookArea& area : profile.areas) {
        if (profile.areas_on_bytes) next = (next + 7) / 8 * 8;
        for (std::size_t k = 0; k < area.hooks; ++k, ++next) {
            bits.push_back(profile.least_bit_first ? next : next / 8 * 8 + (7 - next % 8));
        }
    }
    return bits;
}

}  // namespace

Result<RecordLayout> record_layout(const LoomProfile& profile) {
    RecordLayout layout;
    std::size_t next = 0;
    std::vector<std::size_t> bits = bits_of_places(profile, next);
    layout.bytes = (next + 7) / 8;
    if (bits.size() != profile.total_hooks) return invalid("the profile's areas do not add up to its hooks");
    if (profile.hook_permutation.empty()) {
        layout.bit_of_hook = std::move(bits);
        return layout;
    }
    std::vector<bool> taken(bits.size());
    for (const std::size_t place : profile.hook_permutation) {
        if (place >= bits.size() || taken[place])
            return invalid("the profile's permutation does not give every hook a place of its own");
        taken[place] = true;
        layout.bit_of_hook.push_back(bits[place]);
    }
    if (layout.bit_of_hook.size() != bits.size())
        return invalid("the profile's permutation does not name every hook");
    return layout;
}

std::string records(const HookPlan& plan, const LoomProfile& profile, const RecordLayout& layout) {
    const std::size_t picks = plan.lifts.picks(), record = profile.function_bytes + layout.bytes;
    // Down is 0 or 1, whatever the polarity makes of it; lifting turns the bit over.
    std::string out(picks * record, profile.lifted_is_one ? '\0' : '\xff');
    for (std::size_t k = 0; k < picks; ++k) {
        const std::size_t pick = profile.pick_1_at_bottom ? k : picks - 1 - k;
        char* const at = out.data() + k * record;
        for (std::size_t byte = 0; byte < profile.function_bytes; ++byte) {
            at[byte] = static_cast<char>(plan.function_words[pick] >> 8 * byte & 0xff);
        }
        for (std::size_t hook = 0; hook < plan.lifts.hooks(); ++hook) {
            if (!plan.lifts.lifted(pick, hook)) continue;
            const std::size_t bit = layout.bit_of_hook[hook];
            char& byte = at[profile.function_bytes + bit / 8];
            byte = static_cast<char>(byte ^ 1 << bit % 8);
        }
    }
    return out;
}

}  // namespace weave::loomlink
