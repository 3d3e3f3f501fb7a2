// Rules about the weft and the shed: feeders and lifts.

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

}  // namespace weave::check_detail
