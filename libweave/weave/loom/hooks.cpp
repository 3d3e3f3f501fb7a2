#include <weave/loom/profile.hpp>

#include <bit>

namespace weave {

namespace {

/// The hook at a place of the body, counted through its ranges from the side of end 1.
std::size_t body_hook(const LoomProfile& profile, std::size_t place) {
    if (!profile.end_1_at_left) place = hooks_in(profile.body) - 1 - place;
    for (const auto& range : profile.body) {
        const std::size_t hooks = range.last - range.first + 1;
        if (place < hooks) return range.first + place;
        place -= hooks;
    }
    return profile.total_hooks;
}

void mark(std::vector<HookUse>& uses, const std::vector<HookRange>& ranges, HookUse use) {
    for (const auto& range : ranges) {
        for (std::size_t hook = range.first; hook <= range.last && hook < uses.size(); ++hook)
            uses[hook] = use;
    }
}

void mark(std::vector<HookUse>& uses, const std::vector<std::size_t>& hooks, HookUse use) {
    for (const std::size_t hook : hooks) {
        if (hook < uses.size()) uses[hook] = use;
    }
}

}  // namespace

bool takes_picture(OutputFormat output) {
    return output == OutputFormat::tiff || output == OutputFormat::png || output == OutputFormat::bmp;
}

bool feeders_in_hooks(const LoomProfile& profile) {
    return profile.feeder_encoding == FeederEncoding::hooks ||
           profile.feeder_encoding == FeederEncoding::binary_hooks;
}

std::size_t feeder_places(const LoomProfile& profile) {
    switch (profile.feeder_encoding) {
        case FeederEncoding::none:
            return 0;
        case FeederEncoding::one_hot:
        case FeederEncoding::hooks:
            return profile.feeders;
        case FeederEncoding::binary:
        case FeederEncoding::binary_hooks:
            return static_cast<std::size_t>(std::bit_width(profile.feeders));  // number 0 means no feeder
    }
    return 0;
}

std::size_t hooks_in(const std::vector<HookRange>& ranges) {
    std::size_t hooks = 0;
    for (const auto& range : ranges) hooks += range.last - range.first + 1;
    return hooks;
}

std::size_t most_ends(const LoomProfile& profile) {
    const std::size_t hooks = hooks_in(profile.body);
    switch (profile.hook_rule) {
        case HookRule::straight:
            return hooks;
        case HookRule::point:
            return (hooks + 1) / 2;
        case HookRule::repeats:
            return profile.repeats == 0 ? 0 : hooks / profile.repeats;
        case HookRule::list:
            return profile.hook_of_end.size();
    }
    return 0;
}

std::size_t ends_on_loom(const LoomProfile& profile, std::size_t ends) {
    switch (profile.hook_rule) {
        case HookRule::point:
            return ends == 0 ? 0 : 2 * ends - 1;
        case HookRule::repeats:
            return ends * profile.repeats;
        case HookRule::straight:
        case HookRule::list:
            return ends;
    }
    return ends;
}

std::vector<std::size_t> hooks_of_end(const LoomProfile& profile, std::size_t end, std::size_t ends) {
    if (end >= ends || ends > most_ends(profile)) return {};
    switch (profile.hook_rule) {
        case HookRule::straight:
            return {body_hook(profile, end)};
        case HookRule::list:
            return {profile.hook_of_end[end]};
        case HookRule::point: {
            const std::size_t mirrored = 2 * (ends - 1) - end;
            if (mirrored == end) return {body_hook(profile, end)};
            return {body_hook(profile, end), body_hook(profile, mirrored)};
        }
        case HookRule::repeats: {
            std::vector<std::size_t> hooks;
            for (std::size_t k = 0; k < profile.repeats; ++k)
                hooks.push_back(body_hook(profile, k * ends + end));
            return hooks;
        }
    }
    return {};
}

std::vector<HookUse> hook_uses(const LoomProfile& profile) {
    std::vector<HookUse> uses(profile.total_hooks, HookUse::cast_out);
    mark(uses, profile.body, HookUse::body);
    mark(uses, profile.hook_of_end, HookUse::body);
    mark(uses, profile.selvedge, HookUse::selvedge);
    mark(uses, profile.constant_on, HookUse::constant_on);
    if (feeders_in_hooks(profile)) mark(uses, profile.feeder_hooks, HookUse::feeder);
    mark(uses, profile.regulator_hooks, HookUse::regulator);
    mark(uses, profile.cast_out, HookUse::cast_out);
    return uses;
}

bool selvedge_lifted(const LoomProfile& profile, std::size_t place, std::size_t pick) {
    if (profile.selvedge_weave.empty()) return false;
    const std::string& row = profile.selvedge_weave[pick % profile.selvedge_weave.size()];
    return !row.empty() && row[place % row.size()] == '1';
}

}  // namespace weave
