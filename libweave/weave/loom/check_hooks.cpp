// Rules about hooks: where ends are tied, what never lifts, the selvedge, and what one file holds.

#include <weave/loom/check_detail.hpp>

#include <algorithm>

namespace weave::check_detail {

namespace {

const char* name_of(HookUse use) {
    switch (use) {
        case HookUse::cast_out:
            return "cast out";
        case HookUse::body:
            return "a body hook";
        case HookUse::selvedge:
            return "a selvedge hook";
        case HookUse::constant_on:
            return "always lifted";
        case HookUse::feeder:
            return "a feeder's hook";
        case HookUse::regulator:
            return "a hook of the take-up";
    }
    return "";
}

std::vector<std::vector<std::size_t>> tie_up(const Subject& subject) {
    std::vector<std::vector<std::size_t>> hooks(subject.block.ends());
    for (std::size_t end = 0; end < hooks.size(); ++end) {
        hooks[end] = hooks_of_end(subject.profile, end, hooks.size());
    }
    return hooks;
}

void check_fit(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "hooks.fit");
    const std::size_t most = most_ends(subject.profile), ends = subject.block.ends();
    if (ends > most) {
        rule.find(at_end(most), "the design has " + counted(ends, "end") +
                                    ", but this loom carries at most " + std::to_string(most) + "; end " +
                                    person(most) + " is the first without a hook");
    }
}

/// Judged on the hooks themselves, so that a profile put together in code is held to it like one from a file.
void check_cast_outs(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "hooks.castout");
    if (subject.block.ends() > most_ends(subject.profile)) {
        return rule.not_evaluated("the ends do not fit the hooks (hooks.fit)");
    }
    const auto uses = hook_uses(subject.profile);
    const auto hooks = tie_up(subject);
    for (std::size_t end = 0; end < hooks.size(); ++end) {
        for (const std::size_t hook : hooks[end]) {
            if (hook >= uses.size()) {
                rule.find(at_end(end), "end " + person(end) + " is tied to hook " + person(hook) +
                                           ", but the loom has " + counted(uses.size(), "hook"));
            } else if (uses[hook] != HookUse::body) {
                rule.find(at_end(end), "end " + person(end) + " is tied to hook " + person(hook) +
                                           ", which is " + name_of(uses[hook]));
            }
        }
    }
}

/// Lifts of all hooks on one pick: what a controller would be sent for the body.
std::vector<char> lifts_of(const Subject& subject, const std::vector<std::vector<std::size_t>>& hooks,
                           std::size_t pick) {
    std::vector<char> lifted(subject.profile.total_hooks, 0);
    for (std::size_t end = 0; end < hooks.size(); ++end) {
        if (subject.card.weft_over(pick, end)) continue;
        for (const std::size_t hook : hooks[end]) {
            if (hook < lifted.size()) lifted[hook] = 1;
        }
    }
    return lifted;
}

/// Reads the lifts hook by hook, as a decoder does: the end that each body hook carries, not the hooks of
/// each end.
void check_read_back(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "hooks.read-back");
    if (!rule.wanted()) return;
    if (subject.block.ends() > most_ends(subject.profile)) {
        return rule.not_evaluated("the ends do not fit the hooks (hooks.fit)");
    }
    const auto hooks = tie_up(subject);
    std::vector<std::size_t> ends_in_order;
    std::vector<std::size_t> hooks_in_order;
    std::vector<std::size_t> tied(hooks.size(), 0);
    for (std::size_t end = 0; end < hooks.size(); ++end) {
        for (const std::size_t hook : hooks[end]) {
            if (hook >= subject.profile.total_hooks) continue;
            ends_in_order.push_back(end);
            hooks_in_order.push_back(hook);
            ++tied[end];
        }
        if (tied[end] == 0) rule.find(at_end(end), "end " + person(end) + " is tied to no hook of this loom");
    }
    for (std::size_t pick = 0; pick < subject.block.picks(); ++pick) {
        const auto lifted = lifts_of(subject, hooks, pick);
        for (std::size_t k = 0; k < ends_in_order.size(); ++k) {
            const bool down = subject.card.weft_over(pick, ends_in_order[k]);
            if (down != (lifted[hooks_in_order[k]] != 0)) continue;
            rule.find({pick, ends_in_order[k]},
                      "on pick " + person(pick) + " end " + person(ends_in_order[k]) + " should be " +
                          (down ? "down" : "lifted") + ", but hook " + person(hooks_in_order[k]) +
                          ", which another end shares, does the opposite");
        }
    }
}

std::size_t selvedge_hooks(const LoomProfile& profile) {
    std::size_t hooks = 0;
    for (const auto& range : profile.selvedge) hooks += range.last - range.first + 1;
    return hooks;
}

void check_selvedge_needed(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "selvedge.needed");
    if (subject.profile.insertion == Insertion::shuttle) {
        return rule.not_evaluated("a shuttle's weft turns at the edge, so this loom needs no extra selvedge");
    }
    if (selvedge_hooks(subject.profile) == 0) {
        rule.find({},
                  "this loom cuts each pick, but its profile has no selvedge hooks: the edges would fray");
    }
}

/// Whether a selvedge end passes to both sides of the picks that carry a weft: it is held by those alone.
bool selvedge_end_binds(const Subject& subject, std::size_t place) {
    bool over = false, under = false;
    for (std::size_t pick = 0; pick < subject.picks.size(); ++pick) {
        if (subject.picks[pick].feeders.empty()) continue;
        (selvedge_lifted(subject.profile, place, pick) ? over : under) = true;
    }
    return over && under;
}

void check_selvedge_ends(const Subject& subject, RuleReport& rule) {
    std::size_t place = 0;
    for (const auto& range : subject.profile.selvedge) {
        for (std::size_t hook = range.first; hook <= range.last; ++hook, ++place) {
            if (selvedge_end_binds(subject, place)) continue;
            rule.find({}, "selvedge hook " + person(hook) +
                              " is lifted on all or on none of this design's picks that carry a weft, so its "
                              "end does not bind");
        }
    }
}

/// The first pick of each line of the selvedge weave that passes all selvedge ends on one side.
void check_selvedge_picks(const Subject& subject, std::size_t hooks, RuleReport& rule) {
    const std::vector<std::string>& weave = subject.profile.selvedge_weave;
    std::vector<bool> told(weave.size());
    for (std::size_t pick = 0; pick < subject.picks.size(); ++pick) {
        const std::size_t line = pick % weave.size();
        if (subject.picks[pick].feeders.empty() || told[line]) continue;
        const std::string used = weave[line].substr(0, hooks);
        if (used.find_first_not_of(used[0]) != std::string::npos) continue;
        told[line] = true;
        rule.find(at_pick(pick), "pick " + person(pick) +
                                     " passes all selvedge ends on one side, so the selvedge does not hold it");
    }
}

void check_selvedge_binds(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "selvedge.binds");
    const std::size_t hooks = selvedge_hooks(subject.profile);
    if (hooks == 0) return rule.not_evaluated("the profile has no selvedge hooks");
    if (subject.profile.selvedge_weave.empty())
        return rule.not_evaluated("the profile gives no weave for its selvedge hooks");
    check_selvedge_ends(subject, rule);
    check_selvedge_picks(subject, hooks, rule);
}

void check_picks(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "picks.limit");
    const std::size_t most = subject.profile.limits.picks, extra = subject.profile.lead_in_picks;
    if (most == 0) return rule.not_evaluated("the profile sets no limit of picks");
    if (subject.block.picks() + extra > most) {
        std::string message = "the design has " + counted(subject.block.picks(), "pick");
        if (extra > 0) message += " and " + std::to_string(extra) + " of lead-in";
        rule.find(at_pick(most > extra ? most - extra : 0),
                  message + ", but one file of this loom holds at most " + std::to_string(most));
    }
}

/// Characters of a UTF-8 text.
std::size_t characters(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

void check_name(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "name.limit");
    const std::size_t most = subject.profile.name_limit;
    const std::string& title = subject.design.title;
    if (most == 0) return rule.not_evaluated("the profile sets no limit for names");
    if (characters(title) > most) {
        rule.find({}, "the title '" + title + "' has " + counted(characters(title), "character") +
                          ", but the file has room for " + std::to_string(most) +
                          ": give the file a shorter name on release");
    }
    const bool plain = std::all_of(title.begin(), title.end(), [](char c) { return c >= 0x20 && c < 0x7f; });
    if (!plain)
        rule.find({}, "the title '" + title + "' has characters that the loom's name field cannot show");
}

}  // namespace

void check_hooks(const Subject& subject, CheckReport& report) {
    check_fit(subject, report);
    check_cast_outs(subject, report);
    check_read_back(subject, report);
    check_picks(subject, report);
    check_name(subject, report);
    check_selvedge_needed(subject, report);
    check_selvedge_binds(subject, report);
}

}  // namespace weave::check_detail
