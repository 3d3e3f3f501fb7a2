#include "simulate_ending.hpp"

#include <weave/core/text.hpp>
#include <weave/design/document.hpp>
#include <weave/design/edit.hpp>
#include <weave/sim/starts.hpp>
#include <weave/sim/symmetry.hpp>

#include <algorithm>
#include <cstdio>

namespace weave::program {

namespace {

std::string flips_in_words(const Json& report) {
    std::string text;
    if (!report.contains("flips")) return text;
    for (const Json& flip : report.at("flips")) {
        const std::string pair = "pick " + std::to_string(flip.at("pick").get<std::size_t>()) + " and end " +
                                 std::to_string(flip.at("end").get<std::size_t>());
        char seconds[40];
        std::snprintf(seconds, sizeof seconds, " (%.2f s)\n",
                      flip.at("flip_seconds").get<double>() + flip.at("settle_seconds").get<double>());
        text += flip.at("done").get<bool>() ? pair + " have changed sides" + seconds
                                            : pair + " stay as they were: " + flip.at("reason").get<std::string>() + "\n";
    }
    return text;
}

/// Which part of the cloth was simulated, where it is not all.
std::string coverage_in_words(const Json& report) {
    const Json& coverage = report.at("coverage");
    if (coverage.at("whole").get<bool>() || !coverage.contains("picks")) return "";
    const auto number = [&](const char* name, std::size_t k) { return std::to_string(coverage.at(name).at(k).get<std::size_t>()); };
    return "only picks " + number("picks", 0) + " to " + number("picks", 1) + " and ends " + number("ends", 0) + " to " +
           number("ends", 1) + " of the cloth\n";
}

std::string friction_in_words(const Json& report) {
    if (!report.contains("friction")) return "";
    const Json& friction = report.at("friction");
    char line[200];
    std::snprintf(line, sizeof line, "friction %g: its forces %s after %zu rounds; %.0f %% of what presses sticks, the rest slipped by up to %.2f mm\n",
                  friction.at("coefficient").get<double>(), friction.at("agreed").get<bool>() ? "agree with the rest" : "do NOT agree with the rest",
                  friction.at("rounds").get<std::size_t>(), 100 * friction.at("stuck_share").get<double>(),
                  friction.at("farthest_slip_mm").get<double>());
    return line;
}

/// Which points it began in, and whether the others went on from there.
std::string start_in_words(const Json& report) {
    if (!report.contains("coarser") || report.contains("goes_on")) return "";
    const Json& coarser = report.at("coarser");
    char line[200];
    std::snprintf(line, sizeof line, "began in %zu points (%s): residual %.1e after %zu steps and %.2f s%s\n",
                  coarser.at("points").get<std::size_t>(), coarser.at("fidelity").get<std::string>().c_str(),
                  coarser.at("residual").get<double>(), coarser.at("iterations").get<std::size_t>(), coarser.at("seconds").get<double>(),
                  coarser.at("taken").get<bool>() ? "" : "; NOT gone on from, as crossings lay wrong in so few: begun anew as planned");
    return line;
}

std::string interruption_in_words(const Json& report) {
    if (!report.contains("left_undone")) return "";
    std::string text = report.contains("interrupted") ? "INTERRUPTED, left undone: " : "CUT SHORT, left undone: ";
    for (const Json& what : report.at("left_undone")) text += (text.back() == ' ' ? "" : ", ") + what.get<std::string>();
    return text + "\n";
}

/// Periods that should have relaxed and did not come to the force asked for.
std::string periods_in_words(const Json& report) {
    if (!report.contains("periods") || report.at("periods").at("balanced").get<bool>()) return "";
    const Json& periods = report.at("periods");
    std::string text;
    for (const std::size_t k : {0, 1}) {
        if (periods.at("asked_N").at(k).is_null()) continue;
        char line[200];
        std::snprintf(line, sizeof line, "the period along %c is NOT settled after %zu rounds: its rim pulls with %.3g N, asked for were %.3g N\n",
                      k == 0 ? 'x' : 'y', periods.at("rounds").get<std::size_t>(), periods.at("force_N").at(k).get<double>(),
                      periods.at("asked_N").at(k).get<double>());
        text += line;
    }
    return text;
}

/// Whether it is at rest, and where it never came to what was asked for, whose yarns these are.
std::string rest_in_words(const Json& report) {
    if (!report.contains("goes_on")) return report.at("converged").get<bool>() ? "at rest" : "NOT at rest";
    return "NOT at rest: " + report.at("goes_on").get<std::string>() + ", which was asked for, was not begun; these are the yarns in the fewer points of " +
           report.at("fidelity").get<std::string>();
}

bool is_any_flip_done(const Json& report) {
    return std::ranges::any_of(report.at("flips"), [](const Json& flip) { return flip.at("done").get<bool>(); });
}

}  // namespace

Result<Design> with_flips_made(Design design, const std::vector<Flip>& flips, const Json& report) {
    const Json told = report.value("flips", Json::array());
    for (std::size_t k = 0; k < std::min(told.size(), flips.size()); ++k) {
        if (told.at(k).at("done").get<bool>()) WEAVE_CHECK_OK(apply_edit(design, PutFlip{design.root, flips[k]}));
    }
    return design;
}

std::string ending_in_words(const Json& report) {
    const Json& goal = (report.contains("goes_on") ? report.at("coarser") : report).at("goal");
    char line[300];
    std::snprintf(line, sizeof line, "%s: residual %.1e (goal %.0e) after %zu steps and %.2f s, %zu points, greatest overlap %.0f %%\n",
                  rest_in_words(report).c_str(), report.at("residual").get<double>(), goal.get<double>(), report.at("iterations").get<std::size_t>(), report.at("seconds").get<double>(),
                  report.at("points").get<std::size_t>(), 100 * report.at("max_overlap").get<double>());
    const auto lost = report.at("lost_crossings").get<std::size_t>();
    const auto slid = report.at("slid_crossings").get<std::size_t>();
    std::string order = lost > 0 ? counted(lost, "crossing") + " no longer as the card says\n"
                        : slid > 0 ? "" : "every crossing lies as the card says\n";
    if (slid > 0) order += counted(slid, "crossing") + " no longer where planned, open or not held; no yarn passed through another there\n";
    return line + start_in_words(report) + periods_in_words(report) + order + coverage_in_words(report) + friction_in_words(report) + flips_in_words(report) +
           sim::starts_text(report) + sim::symmetry_text(report) + interruption_in_words(report);
}

std::vector<std::string> left_undone(const Json& report, const Asked& asked) {
    std::vector<std::string> undone;
    const auto add = [&](std::size_t done, std::size_t wanted, const char* what) {
        if (done < wanted) undone.push_back(std::to_string(wanted - done) + " of " + counted(wanted, what));
    };
    const Json flips = report.value("flips", Json::array());
    const std::string ending = report.at("ending");
    if (report.contains("goes_on")) undone.push_back("the fidelity asked for, " + report.at("goes_on").get<std::string>());
    else if (ending == "stopped" || ending == "time" || ending == "iterations") undone.emplace_back("coming to rest");
    add(static_cast<std::size_t>(std::ranges::count_if(flips, [](const Json& flip) { return flip.at("tried").get<bool>(); })),
        asked.flips, "flip");
    add(report.value("starts", Json::object()).value("runs", std::size_t{0}), asked.starts, "more relaxation");
    if (asked.symmetry && !report.contains("symmetry")) undone.emplace_back("the whole cloth beside its smallest repeat");
    return undone;
}

bool is_good(const Json& report) {
    const auto is_done = [](const Json& flip) { return flip.at("done").get<bool>(); };
    const Json flips = report.value("flips", Json::array());
    return !report.contains("left_undone") && report.at("converged").get<bool>() && report.at("order_kept").get<bool>() &&
           std::all_of(flips.begin(), flips.end(), is_done);
}

Status tell_ending(CommandOutcome& outcome, const Json& report, Json answer, const FlippedDesign& flipped) {
    std::string words = on_one_line(answer.at("file").get<std::string>()) + ", " + ending_in_words(report);
    if (!flipped.file.empty()) {
        const bool any = is_any_flip_done(report);
        answer["saved_design"] = any ? Json(flipped.file) : Json(nullptr);
        if (!any) words += on_one_line(flipped.file) + " is NOT written: no flip was made\n";
        if (any) {
            WEAVE_TRY(const Design made, with_flips_made(flipped.design, flipped.flips, report));
            WEAVE_CHECK_OK(save_design(made, flipped.file));
        }
    }
    outcome.answer(answer, words);
    if (!is_good(report)) outcome.found_something();
    return {};
}

}  // namespace weave::program
