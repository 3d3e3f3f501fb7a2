// Rules about the selvedge. Its weave repeats over hooks and picks, so everything about it is seen on one
// repeat: each place of a line, and each line that a pick with a weft takes.

#include <weave/loom/check_detail.hpp>

#include <algorithm>

namespace weave::check_detail {

namespace {

void check_needed(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "selvedge.needed");
    if (subject.profile.insertion == Insertion::shuttle) {
        return rule.not_evaluated("a shuttle's weft turns at the edge, so this loom needs no extra selvedge");
    }
    if (hooks_in(subject.profile.selvedge) == 0) {
        rule.find({},
                  "this loom cuts each pick, but its profile has no selvedge hooks: the edges would fray");
    }
}

/// A line of the selvedge weave, and the first pick with a weft that takes it.
struct Line {
    std::size_t number = 0, pick = 0;
};

/// The lines that hold a weft; the others neither hold an end nor need to be held.
std::vector<Line> lines_with_weft(const Subject& subject) {
    std::vector<bool> known(subject.profile.selvedge_weave.size());
    std::vector<Line> lines;
    for (std::size_t pick = 0; pick < subject.picks.size(); ++pick) {
        const std::size_t number = pick % known.size();
        if (known[number] || subject.picks[pick].feeders.empty()) continue;
        known[number] = true;
        lines.push_back({number, pick});
    }
    return lines;
}

/// How many hooks, counted through the ranges, before the weave has shown all its columns.
std::size_t columns_of(const LoomProfile& profile) {
    std::size_t columns = 0;
    for (const std::string& line : profile.selvedge_weave) columns = std::max(columns, line.size());
    return columns;
}

void check_ends(const LoomProfile& profile, const std::vector<Line>& lines, RuleReport& rule) {
    std::vector<bool> binds(columns_of(profile));
    for (std::size_t column = 0; column < binds.size(); ++column) {
        for (const Line& line : lines) {
            if (selvedge_lifted(profile, column, line.number) !=
                selvedge_lifted(profile, column, lines.front().number)) {
                binds[column] = true;
                break;
            }
        }
    }
    std::size_t place = 0;
    for (const HookRange& range : profile.selvedge) {
        for (std::size_t hook = range.first; hook <= range.last; ++hook, ++place) {
            if (binds[place % binds.size()]) continue;
            rule.find({}, "selvedge hook " + person(hook) +
                              " is lifted on all or on none of this design's picks that carry a weft, so its "
                              "end does not bind");
        }
    }
}

/// The selvedge of one side: its hooks, and where they stand in the count through the ranges.
struct SelvedgeSide {
    std::size_t first_hook = 0, last_hook = 0, first_place = 0, hooks = 0;
};

/// Ranges with no body hook between them stand on one side of the cloth.
std::vector<SelvedgeSide> sides_of(const LoomProfile& profile) {
    const std::vector<HookUse> uses = hook_uses(profile);
    const auto body_between = [&](std::size_t a, std::size_t b) {
        const auto at = [&](std::size_t hook) {
            return uses.begin() + static_cast<std::ptrdiff_t>(std::min(hook, uses.size()));
        };
        return std::find(at(std::min(a, b)), at(std::max(a, b)), HookUse::body) != at(std::max(a, b));
    };
    std::vector<SelvedgeSide> sides;
    std::size_t place = 0;
    for (const HookRange& range : profile.selvedge) {
        if (sides.empty() || body_between(sides.back().last_hook, range.first)) {
            sides.push_back({range.first, range.last, place, 0});
        }
        const std::size_t hooks = range.last - range.first + 1;
        sides.back().last_hook = range.last;
        sides.back().hooks += hooks;
        place += hooks;
    }
    return sides;
}

bool holds(const SelvedgeSide& side, const LoomProfile& profile, std::size_t line) {
    const std::size_t most = std::min(side.hooks, profile.selvedge_weave[line].size());
    for (std::size_t k = 1; k < most; ++k) {
        if (selvedge_lifted(profile, side.first_place + k, line) !=
            selvedge_lifted(profile, side.first_place, line))
            return true;
    }
    return false;
}

void check_picks(const LoomProfile& profile, const std::vector<Line>& lines, RuleReport& rule) {
    const auto sides = sides_of(profile);
    for (const Line& line : lines) {
        for (const SelvedgeSide& side : sides) {
            if (holds(side, profile, line.number)) continue;
            rule.find(at_pick(line.pick), "pick " + person(line.pick) +
                                              " passes all selvedge ends of hooks " +
                                              person(side.first_hook) + " to " + person(side.last_hook) +
                                              " on one side, so the selvedge does not hold it there");
        }
    }
}

void check_binds(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "selvedge.binds");
    if (hooks_in(subject.profile.selvedge) == 0)
        return rule.not_evaluated("the profile has no selvedge hooks");
    if (columns_of(subject.profile) == 0)
        return rule.not_evaluated("the profile gives no weave for its selvedge hooks");
    const auto lines = lines_with_weft(subject);
    check_ends(subject.profile, lines, rule);
    check_picks(subject.profile, lines, rule);
}

}  // namespace

void check_selvedge(const Subject& subject, CheckReport& report) {
    check_needed(subject, report);
    check_binds(subject, report);
}

}  // namespace weave::check_detail
