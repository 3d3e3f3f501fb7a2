// Rules about the warp and its way through the loom: take-up, reed, density, width, consumption.

#include <weave/loom/check_detail.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace weave::check_detail {

namespace {

std::string decimal(double value) {
    char text[64];
    std::snprintf(text, sizeof text, "%.1f", value);
    return text;
}

/// The picks of a row lie on top of each other only if the cloth stands still until the last of them is in.
void check_stops(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "take-up.stop");
    for (std::size_t k = 0; k < subject.picks.size(); ++k) {
        const Pick& pick = subject.picks[k];
        const bool last_of_row = k + 1 == subject.picks.size() || subject.picks[k + 1].row != pick.row;
        if (pick.take_up == last_of_row) continue;
        rule.find(at_pick(k),
                  pick.take_up ? "the cloth advances after pick " + person(k) + ", in the middle of row " +
                                     person(pick.row) + ", so the picks of this row do not stack"
                               : "the cloth does not advance after pick " + person(k) + ", the last of row " +
                                     person(pick.row) + ", so the next row falls on top of it");
    }
}

void check_regulator(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "take-up.regulator");
    const auto stop =
        std::find_if(subject.picks.begin(), subject.picks.end(), [](const Pick& p) { return !p.take_up; });
    if (stop == subject.picks.end() || !subject.profile.regulator_hooks.empty()) return;
    const auto stops = std::count_if(stop, subject.picks.end(), [](const Pick& p) { return !p.take_up; });
    rule.find(
        at_pick(static_cast<std::size_t>(stop - subject.picks.begin())),
        "the cloth has to stand still after " + counted(static_cast<std::size_t>(stops), "pick") +
            ", but the profile names no hook that stops the take-up: set it on the loom by the pick table");
}

struct Spread {
    std::size_t least = 0, most = 0;  ///< ends
    bool seen = false;
};

/// The first end without a take-up that is not loose all along, on purpose: those take up nothing.
std::optional<std::size_t> missing_end(const Subject& subject, const TakeUps& take_ups) {
    if (std::none_of(take_ups.begin(), take_ups.end(), [](double t) { return std::isnan(t); })) return {};
    const CardImage loose = loose_ends(subject.block);
    for (std::size_t end = 0; end < take_ups.size(); ++end) {
        if (!std::isnan(take_ups[end])) continue;
        for (std::size_t pick = 0; pick < loose.picks(); ++pick) {
            if (!loose.weft_over(pick, end)) return end;
        }
    }
    return {};
}

void check_beams(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "take-up.beam");
    const auto limit = subject.profile.limits.take_up_difference;
    if (!subject.take_ups)
        return rule.not_evaluated("needs the take-up of each end from a relaxed simulation");
    if (!limit)
        return rule.not_evaluated("the profile sets no limit for the spread of take-up within a beam");
    const TakeUps& take_ups = *subject.take_ups;
    if (take_ups.size() != subject.block.ends()) {
        return rule.not_evaluated("the take-ups are of " + counted(take_ups.size(), "end") +
                                  ", the design has " + std::to_string(subject.block.ends()));
    }
    if (std::any_of(take_ups.begin(), take_ups.end(), [](double t) { return std::isinf(t); })) {
        return rule.not_evaluated("the take-ups are not all numbers");
    }
    if (const auto end = missing_end(subject, take_ups))
        return rule.not_evaluated("the take-up of end " + person(*end) + " is missing");
    const WarpPlan& warp = subject.design.warp;
    std::vector<Spread> spreads(warp.beams.size());
    for (std::size_t end = 0; end < take_ups.size(); ++end) {
        if (std::isnan(take_ups[end])) continue;
        Spread& spread = spreads.at(warp.beam_order.at(end));
        if (!spread.seen) spread = {end, end, true};
        if (take_ups[end] < take_ups[spread.least]) spread.least = end;
        if (take_ups[end] > take_ups[spread.most]) spread.most = end;
    }
    for (std::size_t beam = 0; beam < spreads.size(); ++beam) {
        const Spread& spread = spreads[beam];
        const double difference = spread.seen ? take_ups[spread.most] - take_ups[spread.least] : 0;
        if (difference <= *limit) continue;
        rule.find(at_end(spread.most), "on beam '" + warp.beams[beam].name + "' end " + person(spread.most) +
                                           " takes up " + percent(take_ups[spread.most]) + " and end " +
                                           person(spread.least) + " only " + percent(take_ups[spread.least]) +
                                           "; this loom's limit is a difference of " + percent(*limit));
    }
}

void check_width(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "reed.width");
    const auto limit = subject.profile.limits.reed_width_mm;
    if (!limit) return rule.not_evaluated("the profile does not tell the width of the reed");
    const std::size_t ends =
        ends_on_loom(subject.profile, subject.block.ends()) + hooks_in(subject.profile.selvedge);
    const double width_mm = 10 * static_cast<double>(ends) / subject.design.warp.density_ends_per_cm;
    if (width_mm <= *limit) return;
    const bool selvedge = hooks_in(subject.profile.selvedge) > 0;
    rule.find({}, counted(ends, "end") + (selvedge ? ", the selvedge among them," : "") + " at " +
                      decimal(subject.design.warp.density_ends_per_cm) + " to the centimetre are " +
                      decimal(width_mm) + " mm wide, but the reed takes " + decimal(*limit) + " mm");
}

void check_dents(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "reed.dents");
    const std::size_t in_dent = subject.design.warp.ends_per_dent,
                      left = in_dent == 0 ? 0 : ends_on_loom(subject.profile, subject.block.ends()) % in_dent;
    if (in_dent == 0) return rule.not_evaluated("the design does not tell how many ends go through a dent");
    if (left == 0) return;
    rule.find({}, "with " + counted(in_dent, "end") + " to a dent the last dent holds only " +
                      std::to_string(left));
}

/// A warp is set up only so exactly; less than this share of the harness's density is no difference.
constexpr double density_tolerance = 0.01;

void check_density(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "warp.density");
    const auto harness = subject.profile.density_ends_per_cm;
    if (!harness) return rule.not_evaluated("the profile does not tell the density of the harness");
    const double density = subject.design.warp.density_ends_per_cm;
    if (std::abs(density - *harness) <= density_tolerance * *harness) return;
    rule.find({}, "the design has " + decimal(density) + " ends to the centimetre, the harness " +
                      decimal(*harness) + ": the cloth comes out " +
                      (density > *harness ? "wider" : "narrower") + " than drawn");
}

}  // namespace

void check_warp(const Subject& subject, CheckReport& report) {
    check_stops(subject, report);
    check_regulator(subject, report);
    check_beams(subject, report);
    check_width(subject, report);
    check_dents(subject, report);
    check_density(subject, report);
    RuleReport(report, subject.profile, "cloth.width")
        .not_evaluated("needs the cloth as it lies off the loom, from a simulation");
    RuleReport(report, subject.profile, "consumption")
        .not_evaluated("needs the relaxed length of every end and pick from a simulation");
}

}  // namespace weave::check_detail
