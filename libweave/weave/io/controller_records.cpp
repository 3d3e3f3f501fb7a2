#include <weave/core/text.hpp>
#include <weave/io/controller_reader.hpp>

#include <algorithm>

namespace weave::controller {

namespace {

/// The bit of each place of the file, from the first bit of a record on, and how many bytes they take.
std::vector<std::size_t> bits_of_places(const LoomProfile& profile, std::size_t& bytes) {
    std::vector<std::size_t> bits;
    std::size_t bit = 0;
    for (const HookArea& area : profile.areas) {
        for (std::size_t k = 0; k < area.hooks; ++k) bits.push_back(bit++);
        if (profile.areas_on_bytes) bit = (bit + 7) / 8 * 8;
    }
    bytes = (bit + 7) / 8;
    return bits;
}

Status check_layout(const LoomProfile& profile) {
    const std::vector<std::size_t>& permutation = profile.hook_permutation;
    std::size_t in_areas = 0;
    for (const HookArea& area : profile.areas) {
        if (area.hooks > most_hooks - in_areas) return bad_input("the profile's areas have too many hooks");
        in_areas += area.hooks;
    }
    if (in_areas == 0 || in_areas != profile.total_hooks)
        return bad_input("the areas of the profile do not add up to its hooks");
    const bool fits = permutation.empty() ||
                      (permutation.size() == in_areas &&
                       std::ranges::all_of(permutation, [&](std::size_t place) { return place < in_areas; }));
    if (!fits) return bad_input("the profile's hook permutation does not fit its hooks");
    const std::size_t most = profile.output == OutputFormat::jc5 ? 0 : most_function_bytes;
    if (profile.function_bytes <= most) return {};
    return bad_input("the profile has " + counted(profile.function_bytes, "function byte") +
                     " a pick, but such a file at most " + std::to_string(most));
}

/// Whether a record says down by each bit that belongs to no hook.
bool is_filled(std::string_view hooks, const HookLayout& layout, bool lifted_is_one) {
    for (std::size_t k = 0; k < hooks.size(); ++k) {
        const int down = lifted_is_one ? 0 : layout.no_hook[k];
        if ((byte_at(hooks, k) & layout.no_hook[k]) != down) return false;
    }
    return true;
}

std::uint64_t function_word(std::string_view bytes) {
    std::uint64_t word = 0;
    for (std::size_t k = 0; k < bytes.size(); ++k) word |= std::uint64_t{byte_at(bytes, k)} << 8 * k;
    return word;
}

}  // namespace

Result<HookLayout> hook_layout(const LoomProfile& profile) {
    WEAVE_CHECK_OK(check_layout(profile));
    HookLayout layout;
    layout.function_bytes = profile.function_bytes;
    const std::vector<std::size_t> bits = bits_of_places(profile, layout.hook_bytes);
    layout.no_hook.assign(layout.hook_bytes, 0xff);
    for (std::size_t hook = 0; hook < profile.total_hooks; ++hook) {
        const std::size_t bit =
            bits[profile.hook_permutation.empty() ? hook : profile.hook_permutation[hook]];
        const std::size_t shift = profile.least_bit_first ? bit % 8 : 7 - bit % 8;
        const auto mask = static_cast<std::uint8_t>(1U << shift);
        layout.hooks.push_back({bit / 8, mask});
        layout.no_hook[bit / 8] &= static_cast<std::uint8_t>(~mask);
    }
    return layout;
}

void read_records(std::string_view bytes, std::size_t picks, const LoomProfile& profile,
                  const HookLayout& layout, ControllerFile& file, Oddities& oddities) {
    file.record_bytes = layout.bytes();
    file.last_pick_first = !profile.pick_1_at_bottom;
    file.lifts = HookLifts(picks, layout.hooks.size());
    for (std::size_t pick = 0; pick < picks; ++pick) {
        const std::size_t at = file.offset_of(pick), hooks_at = at + layout.function_bytes;
        if (layout.function_bytes > 0)
            file.function_words.push_back(function_word(bytes.substr(at, layout.function_bytes)));
        const std::string_view record = bytes.substr(hooks_at, layout.hook_bytes);
        for (std::size_t hook = 0; hook < layout.hooks.size(); ++hook) {
            const bool one = (byte_at(record, layout.hooks[hook].byte) & layout.hooks[hook].mask) != 0;
            if (one == profile.lifted_is_one) file.lifts.lift(pick, hook);
        }
        if (!is_filled(record, layout, profile.lifted_is_one))
            oddities.add(hooks_at, "bits of pick " + std::to_string(pick + 1) +
                                       " that belong to no hook are not down: " + hexadecimal(record));
    }
}

Result<ControllerFile> read_raw(std::string_view bytes, const LoomProfile& profile) {
    WEAVE_TRY(const HookLayout layout, hook_layout(profile));
    if (bytes.empty()) return bad_input("the file is empty", at_byte(0));
    if (const std::size_t rest = bytes.size() % layout.bytes(); rest != 0) {
        return bad_input(
            "the file ends " + counted(rest, "byte") + " into a pick of " + counted(layout.bytes(), "byte"),
            at_byte(bytes.size()));
    }
    ControllerFile file;
    file.format = OutputFormat::raw;
    file.areas = {{"", profile.total_hooks}};
    Oddities oddities;
    read_records(bytes, bytes.size() / layout.bytes(), profile, layout, file, oddities);
    file.warnings = std::move(oddities).take();
    return file;
}

}  // namespace weave::controller
