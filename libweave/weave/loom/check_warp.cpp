// Rules about the warp and its way through the loom: take-up, reed, density.

#include <weave/loom/check_detail.hpp>

#include <algorithm>
#include <cmath>

namespace weave::check_detail {

namespace {

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
    check_width(subject, report);
    check_dents(subject, report);
    check_density(subject, report);
}

}  // namespace weave::check_detail
