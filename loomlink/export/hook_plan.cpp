#include <loomlink/export/hook_plan.hpp>

#include <weave/core/text.hpp>

#include <algorithm>

namespace weave::loomlink {

namespace {

std::string person(std::size_t index) {
    return std::to_string(index + 1);
}

/// A profile that was put together in code is held to what read_profile sees to.
Status check_profile(const LoomProfile& profile) {
    std::size_t hooks = 0;
    for (const HookArea& area : profile.areas) hooks += area.hooks;
    if (hooks != profile.total_hooks || hooks == 0 || hooks > most_hooks)
        return invalid("the profile's areas do not add up to its hooks");
    if (profile.feeder_hooks.size() != feeder_places(profile))
        return invalid("the profile has not a place for each feeder");
    const std::size_t places = feeders_in_hooks(profile) ? hooks : 64;
    for (const std::size_t place : profile.feeder_hooks) {
        if (place >= places) return invalid("the profile selects a feeder by a place that it does not have");
    }
    return {};
}

Status check_size(const CardImage& card, std::size_t picks, const LoomProfile& profile) {
    if (card.picks() != picks)
        return invalid("the pick table has " + counted(picks, "pick") + ", the card " +
                       std::to_string(card.picks()));
    const std::size_t most = most_ends(profile);
    if (card.ends() > most) {
        return invalid("the cloth has " + counted(card.ends(), "end") + ", but this loom carries at most " +
                       std::to_string(most));
    }
    const std::size_t all = picks + profile.lead_in_picks, limit = profile.limits.picks;
    if (limit > 0 && all > limit) {
        return invalid("the cloth has " + counted(all, "pick") +
                       (profile.lead_in_picks > 0 ? " with the lead-in" : "") +
                       ", but one file of this loom holds at most " + std::to_string(limit));
    }
    if (all > most_file_bytes / ((profile.total_hooks + 7) / 8 + profile.function_bytes)) {
        return invalid("the file of " + counted(all, "pick") + " and " +
                       counted(profile.total_hooks, "hook") + " would have more than " +
                       std::to_string(most_file_bytes) + " bytes");
    }
    return {};
}

/// Two yarns cannot come from one place.
Status check_shared_feeders(const Design& design, const std::vector<Pick>& picks, const FeederMap& map) {
    std::map<std::size_t, std::uint32_t> first_on;
    for (const Pick& pick : picks) {
        for (const std::uint32_t feeder : pick.feeders) {
            const std::uint32_t first = first_on.try_emplace(map.at(feeder), feeder).first->second;
            if (design.weft.feeders.at(first).yarn == design.weft.feeders.at(feeder).yarn) continue;
            return invalid("feeders " + person(first) + " and " + person(feeder) +
                           " of the design carry different yarns, but both are mapped to feeder " +
                           person(map.at(feeder)) + " of the loom");
        }
    }
    return {};
}

/// The number of a feeder from 1, digit by digit into the profile's places.
template <class Set>
void set_digits(const LoomProfile& profile, std::size_t feeder, Set set) {
    for (std::size_t digit = 0; digit < profile.feeder_hooks.size(); ++digit) {
        if (((feeder + 1) >> digit & 1) != 0) set(profile.feeder_hooks[digit]);
    }
}

void select_feeders(HookPlan& plan, std::size_t at, const LoomProfile& profile) {
    const auto set_bit = [&](std::size_t bit) { plan.function_words[at] |= std::uint64_t{1} << bit; };
    const auto set_hook = [&](std::size_t hook) { plan.lifts.lift(at, hook); };
    for (const std::size_t feeder : plan.feeders[at]) {
        switch (profile.feeder_encoding) {
            case FeederEncoding::none:
                break;
            case FeederEncoding::one_hot:
                set_bit(profile.feeder_hooks[feeder]);
                break;
            case FeederEncoding::binary:
                set_digits(profile, feeder, set_bit);
                break;
            case FeederEncoding::hooks:
                set_hook(profile.feeder_hooks[feeder]);
                break;
            case FeederEncoding::binary_hooks:
                set_digits(profile, feeder, set_hook);
                break;
        }
    }
}

Status lift_ends(HookPlan& plan, const CardImage& card, const LoomProfile& profile) {
    for (std::size_t end = 0; end < card.ends(); ++end) {
        for (const std::size_t hook : hooks_of_end(profile, end, card.ends())) {
            if (hook >= plan.uses.size() || plan.uses[hook] != HookUse::body)
                return invalid("end " + person(end) + " is tied to hook " + person(hook) +
                               ", which is no body hook");
            for (std::size_t pick = 0; pick < card.picks(); ++pick) {
                if (!card.weft_over(pick, end)) plan.lifts.lift(plan.lead_in + pick, hook);
            }
        }
    }
    return {};
}

/// Ends that share a hook lift each other: where the card wants them apart, the cloth cannot be woven.
Status check_ends(const HookPlan& plan, const CardImage& card, const LoomProfile& profile) {
    if (profile.hook_rule != HookRule::list) return {};
    for (std::size_t end = 0; end < card.ends(); ++end) {
        const std::size_t hook = profile.hook_of_end[end];
        for (std::size_t pick = 0; pick < card.picks(); ++pick) {
            if (plan.lifts.lifted(plan.lead_in + pick, hook) == card.weft_over(pick, end))
                return invalid("end " + person(end) + " shares hook " + person(hook) +
                               " with an end that is lifted on pick " + person(pick) + " when it is not");
        }
    }
    return {};
}

void lift_selvedge(HookPlan& plan, const LoomProfile& profile) {
    std::size_t place = 0;
    for (const HookRange& range : profile.selvedge) {
        for (std::size_t hook = range.first; hook <= range.last; ++hook, ++place) {
            for (std::size_t at = plan.lead_in; at < plan.lifts.picks(); ++at) {
                if (selvedge_lifted(profile, place, at - plan.lead_in)) plan.lifts.lift(at, hook);
            }
        }
    }
}

void lift_constant_on(HookPlan& plan, const LoomProfile& profile) {
    for (const HookRange& range : profile.constant_on) {
        for (std::size_t hook = range.first; hook <= range.last; ++hook) {
            for (std::size_t at = 0; at < plan.lifts.picks(); ++at) plan.lifts.lift(at, hook);
        }
    }
}

Status check_places(const LoomProfile& profile) {
    const auto beyond = [&](const std::vector<HookRange>& ranges) {
        return std::any_of(ranges.begin(), ranges.end(),
                           [&](const HookRange& range) { return range.last >= profile.total_hooks; });
    };
    const auto& stops = profile.regulator_hooks;
    if (beyond(profile.selvedge) || beyond(profile.constant_on) ||
        std::any_of(stops.begin(), stops.end(),
                    [&](std::size_t hook) { return hook >= profile.total_hooks; })) {
        return invalid("the profile names hooks that it does not have");
    }
    return {};
}

/// Whatever the profile and the cloth say: an empty hook lifts nothing.
Status check_cast_outs(const HookPlan& plan) {
    for (std::size_t hook = 0; hook < plan.uses.size(); ++hook) {
        if (plan.uses[hook] != HookUse::cast_out) continue;
        for (std::size_t at = 0; at < plan.lifts.picks(); ++at) {
            if (plan.lifts.lifted(at, hook))
                return invalid("hook " + person(hook) + " is cast out, but would lift");
        }
    }
    return {};
}

}  // namespace

Result<std::vector<std::size_t>> loom_feeders(const Pick& pick, std::size_t number, const FeederMap& map,
                                              const LoomProfile& profile) {
    std::vector<std::size_t> found;
    const std::string on_pick = "pick " + person(number);
    for (const std::uint32_t feeder : pick.feeders) {
        const auto mapped = map.find(feeder);
        if (mapped == map.end())
            return invalid(on_pick + " takes feeder " + person(feeder) +
                           " of the design, which is mapped to no feeder of the loom");
        if (mapped->second >= profile.feeders)
            return invalid("feeder " + person(feeder) + " of the design is mapped to feeder " +
                           person(mapped->second) + ", but the loom has " +
                           counted(profile.feeders, "feeder"));
        if (std::find(found.begin(), found.end(), mapped->second) != found.end())
            return invalid(on_pick + " takes feeder " + person(mapped->second) + " of the loom twice");
        found.push_back(mapped->second);
    }
    const bool binary = profile.feeder_encoding == FeederEncoding::binary ||
                        profile.feeder_encoding == FeederEncoding::binary_hooks;
    const std::size_t most = binary ? 1 : profile.feeders_per_pick;
    if (found.size() > most)
        return invalid(on_pick + " takes " + counted(found.size(), "feeder") + ", but this loom takes " +
                       std::to_string(most) + " at once");
    return found;
}

Result<HookPlan> plan_hooks(const Design& design, const CardImage& card, const std::vector<Pick>& picks,
                            const LoomProfile& profile, const FeederMap& feeders) {
    WEAVE_CHECK_OK(check_profile(profile));
    WEAVE_CHECK_OK(check_places(profile));
    WEAVE_CHECK_OK(check_size(card, picks.size(), profile));
    HookPlan plan;
    plan.lead_in = profile.lead_in_picks;
    plan.uses = hook_uses(profile);
    plan.lifts = LiftTable(plan.lead_in + picks.size(), profile.total_hooks);
    plan.function_words.resize(plan.lifts.picks());
    plan.feeders.resize(plan.lifts.picks());
    for (std::size_t k = 0; k < picks.size(); ++k) {
        const std::size_t at = plan.lead_in + k;
        WEAVE_TRY(plan.feeders[at], loom_feeders(picks[k], k, feeders, profile));
        select_feeders(plan, at, profile);
        if (picks[k].take_up) continue;
        for (const std::size_t hook : profile.regulator_hooks) plan.lifts.lift(at, hook);
    }
    WEAVE_CHECK_OK(check_shared_feeders(design, picks, feeders));
    WEAVE_CHECK_OK(lift_ends(plan, card, profile));
    WEAVE_CHECK_OK(check_ends(plan, card, profile));
    lift_selvedge(plan, profile);
    lift_constant_on(plan, profile);
    WEAVE_CHECK_OK(check_cast_outs(plan));
    return plan;
}

}  // namespace weave::loomlink
