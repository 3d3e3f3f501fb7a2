// Rules that need the cloth as a simulation relaxed it: take-up within a beam, finished width, yarn used.

#include <weave/loom/check_detail.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace weave::check_detail {

namespace {

/// Least and greatest of some ends, and which those are.
struct Spread {
    std::size_t least = 0, most = 0, ends = 0;
    void add(const std::vector<double>& values, std::size_t end) {
        if (ends++ == 0) least = most = end;
        if (values[end] < values[least]) least = end;
        if (values[end] > values[most]) most = end;
    }
};

/// By beam, of the ends that have a value.
std::vector<Spread> spreads_of(const Subject& subject, const std::vector<double>& values) {
    const WarpPlan& warp = subject.design.warp;
    std::vector<Spread> spreads(warp.beams.size());
    for (std::size_t end = 0; end < values.size(); ++end) {
        if (!std::isnan(values[end])) spreads.at(warp.beam_order.at(end)).add(values, end);
    }
    return spreads;
}

/// The first end without a value that is not loose all along, on purpose: those take up nothing.
std::optional<std::size_t> missing_end(const Subject& subject, const std::vector<double>& values) {
    if (std::none_of(values.begin(), values.end(), [](double v) { return std::isnan(v); })) return {};
    const CardImage loose = loose_ends(subject.block);
    for (std::size_t end = 0; end < values.size(); ++end) {
        if (!std::isnan(values[end])) continue;
        for (std::size_t pick = 0; pick < loose.picks(); ++pick) {
            if (!loose.weft_over(pick, end)) return end;
        }
    }
    return {};
}

/// Why values of the ends cannot be judged; empty where they can.
std::string what_is_wrong(const Subject& subject, const std::vector<double>& values,
                          const std::string& what) {
    const std::size_t ends = subject.block.ends();
    if (values.size() != ends)
        return "the simulation tells the " + what + " of " + counted(values.size(), "end") +
               ", the design has " + std::to_string(ends);
    if (std::any_of(values.begin(), values.end(), [](double v) { return std::isinf(v); }))
        return "the simulation's " + what + " of the ends are not all numbers";
    if (const auto end = missing_end(subject, values))
        return "the " + what + " of end " + person(*end) + " is missing in the simulation";
    return "";
}

void check_beams(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "take-up.beam");
    if (!subject.relaxed)
        return rule.not_evaluated("needs the take-up of each end from a relaxed simulation");
    const TakeUps& take_ups = subject.relaxed->take_up;
    if (std::string wrong = what_is_wrong(subject, take_ups, "take-up"); !wrong.empty())
        return rule.not_evaluated(std::move(wrong));
    const auto own = subject.profile.limits.take_up_difference;
    const double limit = own.value_or(usual_take_up_difference);
    const std::vector<Spread> spreads = spreads_of(subject, take_ups);
    for (std::size_t beam = 0; beam < spreads.size(); ++beam) {
        const auto& [least, most, ends] = spreads[beam];
        if (ends == 0) continue;
        const std::string words = "on beam '" + subject.design.warp.beams[beam].name + "' end " +
                                  person(most) + " takes up " + percent(take_ups[most]) + " and end " +
                                  person(least) + " only " + percent(take_ups[least]);
        if (take_ups[most] - take_ups[least] > limit) {
            rule.find(at_end(most), words + "; " +
                                        (own ? "this loom's limit is a difference of " + percent(limit)
                                             : "the profile sets no limit, but beyond a difference of " +
                                                   percent(limit) + " ends usually hang slack"));
        } else if (!own) {
            rule.tell(at_end(most), words + " of " + counted(ends, "end") +
                                        "; the profile sets no limit, and up to " + percent(limit) +
                                        " the warp's stretch usually takes it in");
        }
    }
}

/// How much wider the cloth on the loom is than the design: every repeat, or the mirror image.
double times_across(const Subject& subject) {
    const std::size_t ends = subject.block.ends();
    return static_cast<double>(ends_on_loom(subject.profile, ends)) / static_cast<double>(ends);
}

void check_finished_width(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "cloth.width");
    if (!subject.relaxed)
        return rule.not_evaluated("needs the cloth as it lies off the loom, from a simulation");
    const double width = subject.relaxed->width_mm * times_across(subject);
    if (!(width > 0) || !std::isfinite(width)) return rule.not_evaluated("the simulation tells no width");
    if (!subject.relaxed->width_found)
        return rule.not_evaluated("the simulation was given the width, " + decimal(width) +
                                  " mm: simulate with --boundary y=relaxing, which lets the cloth draw in");
    const double reed = 10 * static_cast<double>(ends_on_loom(subject.profile, subject.block.ends())) /
                        subject.design.warp.density_ends_per_cm;
    const double drawn_in = 1 - width / reed;
    const auto limit = subject.profile.limits.reed_width_mm;
    rule.find({}, "off the loom the cloth is " + decimal(width) + " mm wide, and " + decimal(reed) +
                      " mm in the reed" + (limit ? ", which takes " + decimal(*limit) + " mm" : "") +
                      ": it " + (drawn_in >= 0 ? "draws in" : "widens") + " by " +
                      percent(std::abs(drawn_in)) +
                      (hooks_in(subject.profile.selvedge) > 0 ? ", without the selvedge" : ""));
}

/// So much yarn, for so many mm of cloth.
struct Amount {
    double mm = 0, gram = 0;
    void add(double length_mm, const YarnType& yarn) {
        mm += length_mm;
        gram += length_mm * yarn.linear_density_tex * 1e-6;  // tex: grams for each kilometre
    }
    [[nodiscard]] std::string words(double times) const {
        const double long_mm = mm * times, heavy_g = gram * times;
        return (long_mm < 100 ? decimal(long_mm) + " mm" : decimal(long_mm / 1000, 2) + " m") + " (" +
               (heavy_g < 0.1 ? decimal(1000 * heavy_g) + " mg" : decimal(heavy_g, 2) + " g") + ")";
    }
};

class Consumption {
  public:
    Consumption(const Subject& subject, RuleReport& rule) : m_subject(subject), m_rule(rule) {}

    void tell() {
        for (std::size_t beam = 0; beam < m_subject.design.warp.beams.size(); ++beam) tell_of_beam(beam);
        for (std::size_t feeder = 0; feeder < m_subject.design.weft.feeders.size(); ++feeder)
            tell_of_feeder(feeder);
    }

  private:
    [[nodiscard]] double per_metre() const { return 1000 / m_subject.relaxed->length_mm; }

    [[nodiscard]] std::string amount_words(const Amount& amount) const {
        return amount.words(per_metre()) + " for a metre of cloth, " + amount.words(1) +
               " for one repeat of the design";
    }

    void tell_of_beam(std::size_t beam) {
        const WarpPlan& warp = m_subject.design.warp;
        const std::size_t ends = m_subject.block.ends();
        Spread spread;
        Amount all;
        std::size_t count = 0, loose = 0;
        for (std::size_t end = 0; end < ends; ++end) {
            if (warp.beam_order.at(end) != beam) continue;
            // An end that does not fit on the loom is another rule's finding.
            const std::size_t times =
                std::max<std::size_t>(1, hooks_of_end(m_subject.profile, end, ends).size());
            const bool lies = !std::isnan(m_subject.relaxed->end_mm[end]);
            if (lies) spread.add(m_subject.relaxed->end_mm, end);
            const double mm = lies ? m_subject.relaxed->end_mm[end] : m_subject.relaxed->length_mm;
            all.add(static_cast<double>(times) * mm, yarn_of_end(m_subject.design, end));
            count += times;
            loose += lies ? 0 : times;
        }
        if (count == 0) return;
        const auto each = [&](std::size_t end) {
            return decimal(m_subject.relaxed->end_mm[end] * per_metre() / 1000, 3) + " m (end " +
                   person(end) + ")";
        };
        m_rule.find({}, "beam '" + warp.beams[beam].name + "': " + counted(count, "end") + (count == 1 ? " takes " : " take ") +
                            amount_words(all) +
                            (spread.ends > 0 ? "; each from " + each(spread.least) + " to " +
                                                   each(spread.most) + " for a metre of cloth"
                                             : "") +
                            (loose > 0 ? "; " + std::to_string(loose) +
                                             " of them loose all along, counted with the cloth's length"
                                       : ""));
    }

    void tell_of_feeder(std::size_t feeder) {
        const WeftPlan& weft = m_subject.design.weft;
        const auto takes = [&](const Pick& pick) {
            return std::find(pick.feeders.begin(), pick.feeders.end(), feeder) != pick.feeders.end();
        };
        const auto picks =
            static_cast<std::size_t>(std::count_if(m_subject.picks.begin(), m_subject.picks.end(), takes));
        if (picks == 0) return;
        Amount all;
        all.add(m_subject.relaxed->feeder_mm[feeder] * times_across(m_subject),
                weft.yarns.at(weft.feeders[feeder].yarn));
        m_rule.find({}, "feeder '" + weft.feeders[feeder].name + "': " + counted(picks, "pick") +
                            " of the design" + (picks == 1 ? " takes " : " take ") + amount_words(all));
    }

    const Subject& m_subject;
    RuleReport& m_rule;
};

void check_consumption(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "consumption");
    if (!subject.relaxed)
        return rule.not_evaluated("needs the relaxed length of every end and pick from a simulation");
    const RelaxedCloth& relaxed = *subject.relaxed;
    if (std::string wrong = what_is_wrong(subject, relaxed.end_mm, "length"); !wrong.empty())
        return rule.not_evaluated(std::move(wrong));
    const bool feeders = relaxed.feeder_mm.size() == subject.design.weft.feeders.size() &&
                         std::all_of(relaxed.feeder_mm.begin(), relaxed.feeder_mm.end(),
                                     [](double mm) { return std::isfinite(mm); });
    if (!feeders) return rule.not_evaluated("the simulation does not tell the length from each feeder");
    if (!(relaxed.length_mm > 0) || !std::isfinite(relaxed.length_mm))
        return rule.not_evaluated("the simulation tells no length of the cloth");
    Consumption(subject, rule).tell();
}

}  // namespace

void check_relaxed(const Subject& subject, CheckReport& report) {
    check_beams(subject, report);
    check_finished_width(subject, report);
    check_consumption(subject, report);
}

}  // namespace weave::check_detail
