// Rules about hooks: where ends are tied, what never lifts, and what one file holds.

#include <weave/loom/check_detail.hpp>

#include <algorithm>
#include <map>
#include <optional>

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

using TieUp = std::vector<std::vector<std::size_t>>;  // the hooks of each end

TieUp tie_up(const Subject& subject) {
    TieUp hooks(subject.block.ends());
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
void check_cast_outs(const Subject& subject, const TieUp& hooks, CheckReport& report) {
    RuleReport rule(report, subject.profile, "hooks.castout");
    if (subject.block.ends() > most_ends(subject.profile)) {
        return rule.not_evaluated("the ends do not fit the hooks (hooks.fit)");
    }
    const auto uses = hook_uses(subject.profile);
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

/// The first pick on which two ends do not work alike.
std::optional<std::size_t> first_difference(const CardImage& card, std::size_t a, std::size_t b) {
    for (std::size_t pick = 0; pick < card.picks(); ++pick) {
        if (card.weft_over(pick, a) != card.weft_over(pick, b)) return pick;
    }
    return {};
}

/// A hook lifts all its ends at once.
void check_shared(const Subject& subject, const TieUp& hooks, CheckReport& report) {
    RuleReport rule(report, subject.profile, "hooks.shared");
    if (!rule.wanted()) return;
    if (subject.block.ends() > most_ends(subject.profile)) {
        return rule.not_evaluated("the ends do not fit the hooks (hooks.fit)");
    }
    std::map<std::size_t, std::size_t> first_end;
    for (std::size_t end = 0; end < hooks.size(); ++end) {
        for (const std::size_t hook : hooks[end]) {
            const std::size_t first = first_end.try_emplace(hook, end).first->second;
            const auto pick = first_difference(subject.card, first, end);
            if (!pick) continue;
            rule.find({*pick, end}, "ends " + person(first) + " and " + person(end) + " share hook " +
                                        person(hook) + ", but on pick " + person(*pick) +
                                        " only one of them is to be lifted");
        }
    }
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
                          ": the loom shows no more of it");
    }
    const bool plain = std::all_of(title.begin(), title.end(), [](char c) { return c >= 0x20 && c < 0x7f; });
    if (!plain)
        rule.find({}, "the title '" + title + "' has characters that the loom's name field cannot show");
}

/// The file is no business of this library: whoever writes it says what came of it.
void check_read_back(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "hooks.read-back");
    if (!rule.wanted()) return;
    if (takes_picture(subject.profile.output))
        return rule.not_evaluated("this loom takes a picture, no file of hooks");
    if (!subject.read_back)
        return rule.not_evaluated("needs the file for the controller, which loomlink writes and reads back");
    switch (subject.read_back->outcome) {
        case ReadBack::Outcome::equal:
            return;
        case ReadBack::Outcome::differs:
            return rule.find({}, subject.read_back->words);
        case ReadBack::Outcome::no_file:
            return rule.not_evaluated("there is no file for the controller: " + subject.read_back->words);
    }
}

}  // namespace

void check_hooks(const Subject& subject, CheckReport& report) {
    const TieUp hooks = tie_up(subject);
    check_fit(subject, report);
    check_cast_outs(subject, hooks, report);
    check_shared(subject, hooks, report);
    check_read_back(subject, report);
    check_picks(subject, report);
    check_name(subject, report);
}

}  // namespace weave::check_detail
