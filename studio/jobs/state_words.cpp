#include <studio/jobs/state_words.hpp>

#include <weave/core/text.hpp>
#include <weave/sim/forecast.hpp>
#include <weave/sim/report_words.hpp>

#include <QCoreApplication>

#include <algorithm>
#include <limits>
#include <cmath>

namespace weave::studio {

namespace {

/// So many of a kind are told one by one.
constexpr std::size_t most_told = 3;

struct Words {
    Q_DECLARE_TR_FUNCTIONS(StateWords)
};

QString number(std::uint64_t value) {
    return QString::number(value);
}

QString small(double value) {
    return QString::number(value, 'g', 2);
}

QString percent(double share) {
    return Words::tr("%1 %").arg(100 * share, 0, 'f', 1);
}

/// A count as texts with a plural take it.
int counted(std::uint64_t count) {
    return static_cast<int>(std::min<std::uint64_t>(count, std::numeric_limits<int>::max()));
}

QString steps(std::uint64_t count) {
    return Words::tr("%n step(s)", nullptr, counted(count));
}

QString name_of(System system) {
    return system == System::warp ? Words::tr("end") : Words::tr("pick");
}

QString crossing(const ClothPlace& place) {
    return Words::tr("pick %1, end %2").arg(number(place.pick + 1), number(place.end + 1));
}

/// Where a yarn is crossed by one of the other system.
ClothPlace place_of(const YarnNumber& yarn, std::size_t other) {
    return yarn.system == System::weft ? ClothPlace{yarn.number, other} : ClothPlace{other, yarn.number};
}

QString running_words(const Progress& progress) {
    if (progress.is_flipping) return Words::tr("Leading two yarns past one another …");
    if (progress.history.empty() && progress.step == 0)
        return Words::tr("Still settling: the first step is under way");
    QString text = (progress.is_coarse ? Words::tr("Still settling, as a draft first: residual %1")
                                       : Words::tr("Still settling: residual %1"))
                       .arg(small(progress.residual));
    if (progress.seconds_left) text += Words::tr(", %1 to go").arg(duration_words(*progress.seconds_left));
    if (const std::uint64_t lost = progress.lost_crossings.value_or(0); lost > 0)
        text += Words::tr("; %n crossing(s) no longer lie as the card says", nullptr, counted(lost));
    return text;
}

/// What keeps a run that stands from going on by itself; nothing where it was paused.
QString ending_words(const RunState& state) {
    if (!state.yarns) return {};
    const Json ending = sim::part_of(state.yarns->report, "ending");
    const QString after = steps(state.progress.step), residual = small(state.progress.residual);
    if (ending == "stuck")
        return Words::tr("It gets no further: still at residual %1 after %2. A target strain or a stiffness nearer to the usual, or a higher fidelity, may help").arg(residual, after);
    if (ending == "time")
        return Words::tr("The time is used up after %2: not at rest, residual %1").arg(residual, after);
    return {};
}

QString paused_words(const RunState& state) {
    if (state.progress.step == 0) return Words::tr("Laid out as planned: nothing has moved yet");
    if (const QString ending = ending_words(state); !ending.isEmpty()) return ending;
    return Words::tr("Paused after %1: residual %2")
        .arg(steps(state.progress.step), small(state.progress.residual));
}

QString changed_words(const std::vector<ChangedCrossing>& changed) {
    const ChangedCrossing& first = changed.front();
    return Words::tr("%n crossing(s) no longer lie as the card says", nullptr, counted(changed.size())) +
           Words::tr(" (%1%2)").arg(crossing({first.pick, first.end}),
                                    changed.size() > 1 ? QStringLiteral(" …") : QString());
}

QString jammed_words(const std::vector<JammedYarn>& jammed) {
    const JammedYarn& worst = jammed.front();
    const QString place = crossing(place_of(worst.yarn, worst.between[0]));
    return Words::tr("%n yarn(s) are jammed, tightest at %1", nullptr, counted(jammed.size())).arg(place);
}

QString rest_words(const RunState& state) {
    QString text = Words::tr("At rest within %1 after %2")
                       .arg(small(state.progress.goal), steps(state.progress.step));
    if (!state.inspection) return text;
    if (!state.inspection->changed.empty())
        text += QStringLiteral("; ") + changed_words(state.inspection->changed);
    if (!state.inspection->jammed.empty())
        text += QStringLiteral("; ") + jammed_words(state.inspection->jammed);
    return text;
}

// ---- The inspection ----

using Lines = std::vector<StateLine>;

void add_crossings(Lines& lines, const Inspection& inspection) {
    for (std::size_t k = 0; k < std::min(most_told, inspection.changed.size()); ++k) {
        const ChangedCrossing& one = inspection.changed[k];
        const QString as = one.weft_over ? Words::tr("The pick should lie over the end at %1, and does not")
                                         : Words::tr("The end should lie over the pick at %1, and does not");
        lines.push_back({as.arg(crossing({one.pick, one.end})), ClothPlace{one.pick, one.end}});
    }
    if (inspection.changed.size() > most_told)
        lines.push_back({Words::tr("… and %1 more that no longer lie as the card says")
                             .arg(inspection.changed.size() - most_told),
                         {}});
    if (inspection.changed.empty())
        lines.push_back({Words::tr("Every crossing that is held lies as the card says"), {}});
    if (inspection.slid.empty()) return;
    const ClothPlace place{inspection.slid.front().pick, inspection.slid.front().end};
    lines.push_back({Words::tr("Crossings that hang apart or slid off: %1, such as %2")
                         .arg(number(inspection.slid.size()), crossing(place)),
                     place});
}

void add_crimp(Lines& lines, const QString& name, System system, const std::optional<Spread>& crimp) {
    if (!crimp) return;
    QString text = name.arg(percent(crimp->mean));
    if (crimp->most - crimp->least >= 0.001)
        text += Words::tr(", from %1 to %2 (%3 %4)")
                    .arg(percent(crimp->least), percent(crimp->most), name_of(system),
                         number(crimp->most_of + 1));
    lines.push_back({text, place_of({system, crimp->most_of}, 0)});
}

void add_measures(Lines& lines, const Inspection& inspection) {
    if (inspection.thickness_mm)
        lines.push_back({Words::tr("Thickness %1 mm").arg(*inspection.thickness_mm, 0, 'f', 2), {}});
    add_crimp(lines, Words::tr("Warp crimp %1"), System::warp, inspection.warp_crimp);
    add_crimp(lines, Words::tr("Weft crimp %1"), System::weft, inspection.weft_crimp);
    for (const BeamTakeUp& beam : inspection.beams) {
        QString text =
            Words::tr("Take-up of beam %1: %2").arg(number(beam.beam + 1), percent(beam.spread.mean));
        if (beam.spread.most - beam.spread.least >= 0.001)
            text += Words::tr(", from %1 (end %2) to %3 (end %4)")
                        .arg(percent(beam.spread.least), number(beam.spread.least_of + 1),
                             percent(beam.spread.most), number(beam.spread.most_of + 1));
        lines.push_back({text, ClothPlace{0, beam.spread.most_of}});
    }
}

void add_jammed(Lines& lines, const Inspection& inspection) {
    for (std::size_t k = 0; k < std::min(most_told, inspection.jammed.size()); ++k) {
        const JammedYarn& one = inspection.jammed[k];
        const System other = one.yarn.system == System::warp ? System::weft : System::warp;
        lines.push_back({Words::tr("Jammed: %1 %2 has no straight piece left between %3s %4 and %5")
                             .arg(name_of(one.yarn.system), number(one.yarn.number + 1), name_of(other),
                                  number(one.between[0] + 1), number(one.between[1] + 1)),
                         place_of(one.yarn, one.between[0])});
    }
    if (inspection.jammed.size() > most_told)
        lines.push_back(
            {Words::tr("… and %1 more that are jammed").arg(inspection.jammed.size() - most_told), {}});
}

void add_moved(Lines& lines, const Inspection& inspection) {
    for (std::size_t k = 0; k < std::min(most_told, inspection.moved.size()); ++k) {
        const MovedYarn& one = inspection.moved[k];
        const System other = one.yarn.system == System::warp ? System::weft : System::warp;
        lines.push_back(
            {Words::tr("Moved: %1 %2 lies %3 mm (%4 widths) from its place at %5 %6")
                 .arg(name_of(one.yarn.system), number(one.yarn.number + 1), QString::number(one.mm, 'f', 2),
                      QString::number(one.widths, 'f', 1), name_of(other), number(one.crossed + 1)),
             place_of(one.yarn, one.crossed)});
    }
    if (inspection.moved.size() > most_told)
        lines.push_back({Words::tr("… and %1 more that moved by more than their width")
                             .arg(inspection.moved.size() - most_told),
                         {}});
}

void add_bunched(Lines& lines, const Inspection& inspection) {
    if (inspection.bunched.empty()) return;
    const BunchedPair& nearest = inspection.bunched.front();
    lines.push_back(
        {Words::tr("Bunched neighbours: %1, nearest %2s %3 and %4, %5 mm apart instead of %6")
             .arg(number(inspection.bunched.size()), name_of(nearest.first.system),
                  number(nearest.first.number + 1), number(nearest.second.number + 1),
                  QString::number(nearest.mm, 'f', 2), QString::number(nearest.planned_mm, 'f', 2)),
         place_of(nearest.first, 0)});
}

void add_leaning(Lines& lines, const Inspection& inspection) {
    for (std::size_t k = 0; k < std::min(most_told, inspection.leaning.size()); ++k) {
        const LeaningLayer& one = inspection.leaning[k];
        if (one.numbers.empty()) continue;
        lines.push_back(
            {Words::tr("Leans: layer %1 of %2 of the %3s, by %4 mm (%5 widths)")
                 .arg(number(one.layer + 1), number(one.of), name_of(one.system),
                      QString::number(std::abs(one.mm), 'f', 2), QString::number(one.widths, 'f', 1)),
             place_of({one.system, one.numbers.front()}, 0)});
    }
}

}  // namespace

QString duration_words(double seconds) {
    if (seconds < 1) return Words::tr("less than 1 s");
    if (seconds < 100) return Words::tr("about %1 s").arg(std::ceil(seconds), 0, 'f', 0);
    if (seconds < 100 * 60) return Words::tr("about %1 min").arg(std::ceil(seconds / 60), 0, 'f', 0);
    return Words::tr("about %1 h").arg(std::ceil(seconds / 3600), 0, 'f', 0);
}

QString error_words(const Error& error) {
    return QString::fromStdString(on_one_line(error.text()));
}

QString state_words(const RunState& state) {
    switch (state.phase) {
        case RunPhase::idle:
            return Words::tr("Not simulated yet");
        case RunPhase::planning:
            return Words::tr("Laying out the yarns …");
        case RunPhase::running:
            return running_words(state.progress);
        case RunPhase::paused:
            return paused_words(state);
        case RunPhase::at_rest:
            return rest_words(state);
        case RunPhase::failed:
            return Words::tr("Failed: %1").arg(state.error ? error_words(*state.error) : QString());
        case RunPhase::stopped:
            break;
    }
    if (state.progress.step == 0) return Words::tr("Stopped before the first step");
    return Words::tr("Stopped after %1: residual %2")
        .arg(steps(state.progress.step), small(state.progress.residual));
}

QString dated_words(const RunState& state) {
    const bool shows_cloth = state.phase == RunPhase::running || state.phase == RunPhase::paused || state.phase == RunPhase::at_rest;
    return shows_cloth ? Words::tr("The design before the change: %1").arg(state_words(state)) : state_words(state);
}

std::vector<StateLine> inspection_words(const Inspection& inspection) {
    Lines lines;
    add_crossings(lines, inspection);
    if (inspection.sheets.size() > 1)
        lines.push_back(
            {Words::tr("Falls apart into %n cloth(s) that nothing binds", nullptr, counted(inspection.sheets.size())), {}});
    add_leaning(lines, inspection);
    add_jammed(lines, inspection);
    add_bunched(lines, inspection);
    add_moved(lines, inspection);
    add_measures(lines, inspection);
    return lines;
}

std::vector<QString> plan_words(const PlanSummary& plan) {
    std::vector<QString> lines;
    lines.push_back(Words::tr("%1 on %2; about %3 of memory while it relaxes")
                        .arg(Words::tr("%n control point(s)", nullptr, counted(plan.points)),
                             Words::tr("%n yarn(s)", nullptr, counted(plan.yarns)),
                             QString::fromStdString(sim::memory_text(plan.expected_bytes))));
    for (const sim::PlanLine& line : plan.lines) {
        lines.push_back(Words::tr("%1: %2 – %3")
                            .arg(QString::fromStdString(line.term), QString::fromStdString(line.choice),
                                 QString::fromStdString(line.reason)));
    }
    return lines;
}

}  // namespace weave::studio
