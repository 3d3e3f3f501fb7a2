// Rules about the weft and the shed: feeders, lifts, and the way of a shuttle's yarn.

#include <weave/loom/check_detail.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

namespace weave::check_detail {

namespace {

void check_per_pick(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "feeders.per-pick");
    for (std::size_t k = 0; k < subject.picks.size(); ++k) {
        const std::size_t feeders = subject.picks[k].feeders.size();
        if (feeders <= subject.profile.feeders_per_pick) continue;
        rule.find(at_pick(k), "pick " + person(k) + " takes " + counted(feeders, "feeder") +
                                  " at once, but this loom inserts " +
                                  std::to_string(subject.profile.feeders_per_pick));
    }
}

void check_no_feeder(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "feeders.none");
    for (std::size_t k = 0; k < subject.picks.size(); ++k) {
        if (!subject.picks[k].feeders.empty() || subject.picks[k].take_up) continue;
        rule.find(
            at_pick(k),
            "pick " + person(k) +
                " has no feeder and the cloth does not advance either: a pick without weft may only take up");
    }
}

void check_feeder_range(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "feeders.range");
    std::set<std::uint32_t> told;
    for (std::size_t k = 0; k < subject.picks.size(); ++k) {
        for (const std::uint32_t feeder : subject.picks[k].feeders) {
            if (feeder < subject.profile.feeders || !told.insert(feeder).second) continue;
            rule.find(at_pick(k), "pick " + person(k) + " is the first to take feeder " + person(feeder) +
                                      ", but this loom has " + counted(subject.profile.feeders, "feeder"));
        }
    }
}

/// Ends lifted on each pick.
std::vector<std::size_t> lifts_of(const CardImage& card) {
    std::vector<std::size_t> lifts(card.picks());
    for (std::size_t pick = 0; pick < card.picks(); ++pick) {
        std::size_t down = 0;
        for (const std::uint8_t byte : card.row(pick)) down += static_cast<std::size_t>(std::popcount(byte));
        lifts[pick] = card.ends() - down;
    }
    return lifts;
}

void check_balance(const Subject& subject, const std::vector<std::size_t>& lifts, CheckReport& report) {
    RuleReport rule(report, subject.profile, "lift.balance");
    const auto limit = subject.profile.limits.lift_difference;
    if (!limit) return rule.not_evaluated("the profile sets no limit for the change of lifts between picks");
    const auto ends = static_cast<double>(subject.card.ends());
    for (std::size_t k = 0; k < lifts.size() && lifts.size() > 1; ++k) {
        const std::size_t before = k == 0 ? lifts.size() - 1 : k - 1;
        const double change =
            std::abs(static_cast<double>(lifts[k]) - static_cast<double>(lifts[before])) / ends;
        if (change <= *limit) continue;
        rule.find(at_pick(k), "from pick " + person(before) + " to pick " + person(k) +
                                  " the lifted ends go from " + std::to_string(lifts[before]) + " to " +
                                  std::to_string(lifts[k]) + ", a change of " + percent(change) +
                                  "; this loom's limit is " + percent(*limit));
    }
}

void check_share(const Subject& subject, const std::vector<std::size_t>& lifts, CheckReport& report) {
    RuleReport rule(report, subject.profile, "lift.share");
    const auto limit = subject.profile.limits.lift_share;
    if (!limit) return rule.not_evaluated("the profile sets no limit for the share of lifted ends");
    for (std::size_t k = 0; k < lifts.size(); ++k) {
        const double share = static_cast<double>(lifts[k]) / static_cast<double>(subject.card.ends());
        if (share <= *limit) continue;
        rule.find(at_pick(k), "pick " + person(k) + " lifts " + std::to_string(lifts[k]) + " of " +
                                  counted(subject.card.ends(), "end") + ", " + percent(share) +
                                  "; this loom's limit is " + percent(*limit));
    }
}

void check_face_down(const Subject& subject, const std::vector<std::size_t>& lifts, CheckReport& report) {
    RuleReport rule(report, subject.profile, "lift.face-down");
    std::uint64_t lifted = 0;
    for (const std::size_t on_pick : lifts) lifted += on_pick;
    const std::uint64_t all = std::uint64_t{subject.card.picks()} * subject.card.ends();
    if (lifted <= all - lifted) return;
    rule.find({}, "woven face down, with the card inverted, the loom would lift " +
                      std::to_string(all - lifted) + " times in a repeat instead of " +
                      std::to_string(lifted));
}

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

void check_caught(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "turn.caught");
    if (const std::string reason = no_turns(subject); !reason.empty()) return rule.not_evaluated(reason);
    for (const Turn& turn : subject.way.turns) {
        if (turn.caught_by != CaughtBy::none) continue;
        rule.find(at_pick(turn.to_pick), "the turn on the " + std::string(name_of(turn.side)) +
                                             " from pick " + person(turn.from_pick) + " to pick " +
                                             person(turn.to_pick) +
                                             " is caught by no end and no pick: the weft of feeder " +
                                             person(turn.feeder) + " pulls through");
    }
}

void check_crossed(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "turn.crossed");
    if (const std::string reason = no_turns(subject); !reason.empty()) return rule.not_evaluated(reason);
    std::set<std::pair<std::size_t, std::uint32_t>> uncaught;  // already reported by turn.caught
    for (const Turn& turn : subject.way.turns) {
        if (turn.caught_by != CaughtBy::none) continue;
        uncaught.emplace(turn.from_pick, turn.feeder);
        uncaught.emplace(turn.to_pick, turn.feeder);
    }
    for (const PickSpan& span : subject.way.spans) {
        if (!span.crossed || uncaught.contains({span.pick, span.feeder})) continue;
        rule.find(at_pick(span.pick), "the turns at the two ends of pick " + person(span.pick) +
                                          " pull past each other, so nothing of it stays in the cloth");
    }
}

/// Where a feeder's next pick does not start where its last one ended. Needs no card, so it is judged in
/// periodic mode, too.
void check_box(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "turn.box");
    if (subject.profile.insertion != Insertion::shuttle) {
        return rule.not_evaluated("this loom has no shuttle that would have to stand on one side");
    }
    const CardImage no_ends(subject.picks.size(), 1);
    for (const MissedBox& missed : weft_way(no_ends, subject.picks).missed_boxes) {
        const bool stands_right = subject.picks[missed.from_pick].direction == Direction::left_to_right;
        rule.find(at_pick(missed.to_pick),
                  "pick " + person(missed.to_pick) + " starts on the " + (stands_right ? "left" : "right") +
                      ", but the shuttle of feeder " + person(missed.feeder) + " stands on the " +
                      (stands_right ? "right" : "left") + " since pick " + person(missed.from_pick));
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

void check_lifts(const Subject& subject, CheckReport& report) {
    const auto lifts = lifts_of(subject.card);
    check_balance(subject, lifts, report);
    check_share(subject, lifts, report);
    check_face_down(subject, lifts, report);
}

void check_feeders(const Subject& subject, CheckReport& report) {
    check_per_pick(subject, report);
    check_no_feeder(subject, report);
    check_feeder_range(subject, report);
}

void check_turns(const Subject& subject, CheckReport& report) {
    check_caught(subject, report);
    check_crossed(subject, report);
    check_box(subject, report);
    check_cut(subject, report);
    check_insertion(subject, report);
    check_repeat(subject, report);
}

}  // namespace weave::check_detail
