// Rules about the way of a shuttle's yarn: its turns, its box, and what the loom makes of them.
//
// Where the warp repeats, the last pick of a feeder turns into its first of the next repeat, and a feeder
// with an odd number of picks goes the other way there. So the way is followed through several repeats, and
// the turns are judged that have a repeat before and behind them. It is followed after trimming: what only a
// loose end holds in the loom pulls through when that end is cut off.

#include <weave/loom/check_detail.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace weave::check_detail {

namespace {

const char* name_of(Side side) {
    return side == Side::left ? "left" : "right";
}

const char* name_of(Insertion insertion) {
    switch (insertion) {
        case Insertion::shuttle:
            return "a shuttle";
        case Insertion::rapier:
            return "a rapier";
        case Insertion::air_jet:
            return "an air jet";
    }
    return "";
}

/// Why turns are not judged; empty if they are.
std::string no_turns(const Subject& subject) {
    if (subject.profile.insertion != Insertion::shuttle)
        return "this loom cuts each pick, so its weft has no turns";
    if (!subject.turns)
        return "the design is drawn in periodic mode, where every pick runs from edge to edge";
    return {};
}

/// The picks of several repeats, and those of them that are judged: first … last - 1.
struct Repeats {
    std::vector<Pick> picks;
    std::size_t first = 0, last = 0;
};

Repeats repeats_of(const Subject& subject) {
    const std::size_t in_one = subject.picks.size();
    if (subject.design.scene.boundary_x != Boundary::periodic) return {subject.picks, 0, in_one};
    Repeats repeats{pick_table(subject.design, subject.block, 4), in_one, 3 * in_one};
    const auto second = repeats.picks.begin() + static_cast<std::ptrdiff_t>(in_one);
    const bool alike = std::equal(subject.picks.begin(), subject.picks.end(), second,
                                  [](const Pick& a, const Pick& b) { return a.direction == b.direction; });
    if (!alike) return repeats;
    repeats.picks.resize(3 * in_one);
    repeats.last = 2 * in_one;
    return repeats;
}

/// The way of the weft through several repeats, in the loom and with the loose ends trimmed.
struct Ways {
    Repeats repeats;
    WeftWay woven, trimmed;
    std::size_t in_one = 0;  ///< picks of a repeat

    [[nodiscard]] bool is_judged(std::size_t pick) const {
        return pick >= repeats.first && pick < repeats.last;
    }
};

Ways ways_of(const Subject& subject) {
    Ways ways{repeats_of(subject), {}, {}, subject.picks.size()};
    if (!subject.turns) return ways;
    ways.woven = weft_way(subject.card, ways.repeats.picks);
    ways.trimmed = subject.loose ? weft_way(subject.card, ways.repeats.picks, &*subject.loose) : ways.woven;
    return ways;
}

/// `pick 4`, or `pick 1 of the next repeat` seen from a pick of the repeat before.
std::string pick_after(std::size_t from, std::size_t to, std::size_t in_one) {
    return "pick " + person(to % in_one) + (from / in_one == to / in_one ? "" : " of the next repeat");
}

/// Pick of a repeat and feeder: each is reported once, in whichever repeat it is found.
using Told = std::set<std::pair<std::size_t, std::uint32_t>>;

std::string sentence(const Turn& turn, const Turn& woven, std::size_t in_one) {
    const std::string where = "the turn on the " + std::string(name_of(turn.side)) + " from pick " +
                              person(turn.from_pick % in_one) + " to " +
                              pick_after(turn.from_pick, turn.to_pick, in_one);
    const std::string yarn = "the weft of feeder " + person(turn.feeder) + " pulls through";
    if (woven.caught_by == CaughtBy::none) return where + " is caught by no end and no pick: " + yarn;
    return where + " is held only at end " + person(woven.end) +
           ", which is loose there: once it is trimmed " + yarn;
}

void check_caught(const Subject& subject, const Ways& ways, CheckReport& report) {
    RuleReport rule(report, subject.profile, "turn.caught");
    if (const std::string reason = no_turns(subject); !reason.empty()) return rule.not_evaluated(reason);
    Told told;
    for (std::size_t k = 0; k < ways.trimmed.turns.size(); ++k) {
        const Turn& turn = ways.trimmed.turns[k];
        if (turn.caught_by != CaughtBy::none || !ways.is_judged(turn.to_pick)) continue;
        if (!told.emplace(turn.to_pick % ways.in_one, turn.feeder).second) continue;
        rule.find(at_pick(turn.to_pick % ways.in_one), sentence(turn, ways.woven.turns[k], ways.in_one));
    }
}

void check_crossed(const Subject& subject, const Ways& ways, CheckReport& report) {
    RuleReport rule(report, subject.profile, "turn.crossed");
    if (const std::string reason = no_turns(subject); !reason.empty()) return rule.not_evaluated(reason);
    Told uncaught;  // already reported by turn.caught
    for (const Turn& turn : ways.trimmed.turns) {
        if (turn.caught_by != CaughtBy::none) continue;
        uncaught.emplace(turn.from_pick, turn.feeder);
        uncaught.emplace(turn.to_pick, turn.feeder);
    }
    Told told;
    for (std::size_t k = 0; k < ways.trimmed.spans.size(); ++k) {
        const PickSpan& span = ways.trimmed.spans[k];
        if (!span.crossed || !ways.is_judged(span.pick) || uncaught.contains({span.pick, span.feeder}))
            continue;
        if (!told.emplace(span.pick % ways.in_one, span.feeder).second) continue;
        rule.find(at_pick(span.pick % ways.in_one),
                  "the turns at the two ends of pick " + person(span.pick % ways.in_one) +
                      " pull past each other" +
                      (ways.woven.spans[k].crossed ? "" : " once the loose ends are trimmed") +
                      ", so nothing of it stays in the cloth");
    }
}

/// Where a feeder's next pick does not start where its last one ended. Needs no card, so it is judged in
/// periodic mode, too.
void check_box(const Subject& subject, const Ways& ways, CheckReport& report) {
    RuleReport rule(report, subject.profile, "turn.box");
    if (subject.profile.insertion != Insertion::shuttle) {
        return rule.not_evaluated("this loom has no shuttle that would have to stand on one side");
    }
    Told told;
    for (const MissedBox& missed : missed_boxes(ways.repeats.picks)) {
        if (!told.emplace(missed.to_pick % ways.in_one, missed.feeder).second) continue;
        const bool stands_right = ways.repeats.picks[missed.from_pick].direction == Direction::left_to_right;
        rule.find(at_pick(missed.to_pick % ways.in_one),
                  pick_after(missed.from_pick, missed.to_pick, ways.in_one) + " starts on the " +
                      (stands_right ? "left" : "right") + ", but the shuttle of feeder " +
                      person(missed.feeder) + " stands on the " + (stands_right ? "right" : "left") +
                      " since pick " + person(missed.from_pick % ways.in_one));
    }
}

void check_cut(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "turn.cut");
    if (subject.design.scene.weft_mode != WeftMode::wraparound) {
        return rule.not_evaluated("the design is drawn in periodic mode, without turns");
    }
    if (subject.profile.insertion == Insertion::shuttle) return;
    rule.find({}, "the design relies on weft that turns inside the cloth, but this loom inserts with " +
                      std::string(name_of(subject.profile.insertion)) +
                      " and cuts each pick: no loop will hold");
}

void check_insertion(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "insertion.match");
    if (subject.design.scene.insertion == subject.profile.insertion) return;
    rule.find({}, "the design is drawn for " + std::string(name_of(subject.design.scene.insertion)) +
                      ", but this loom inserts with " + name_of(subject.profile.insertion));
}

void check_repeat(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "repeat.doubled");
    if (subject.profile.insertion != Insertion::shuttle) {
        return rule.not_evaluated("this loom cuts each pick, so each starts afresh");
    }
    std::map<std::uint32_t, std::size_t> counts;
    for (const Pick& pick : subject.picks) {
        for (const std::uint32_t feeder : pick.feeders) ++counts[feeder];
    }
    for (const auto& [feeder, picks] : counts) {
        if (picks % 2 == 0) continue;
        rule.find({}, "feeder " + person(feeder) + " makes " + counted(picks, "pick") +
                          " in a repeat, an odd number: its shuttle ends on the other side, so only two "
                          "repeats are a whole round");
    }
}

}  // namespace

void check_turns(const Subject& subject, CheckReport& report) {
    const Ways ways = ways_of(subject);
    check_caught(subject, ways, report);
    check_crossed(subject, ways, report);
    check_box(subject, ways, report);
    check_cut(subject, report);
    check_insertion(subject, report);
    check_repeat(subject, report);
}

}  // namespace weave::check_detail
