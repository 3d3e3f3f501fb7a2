// The inspection in a weaver's words.

#include <weave/core/text.hpp>
#include <weave/sim/inspect.hpp>
#include <weave/sim/report_words.hpp>
#include <weave/sim/starts.hpp>
#include <weave/sim/symmetry.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

namespace weave {

namespace {

/// So many of a kind are told one by one; the JSON has them all.
constexpr std::size_t most_told = 3;
constexpr std::size_t most_numbers = 4;

template <class... Values>
std::string format(const char* pattern, Values... values) {
    std::array<char, 200> text{};
    std::snprintf(text.data(), text.size(), pattern, values...);
    return text.data();
}

std::string mm(double length) {
    return format("%.2f mm", length);
}

std::string percent(double share) {
    return format("%.1f %%", 100 * share);
}

std::string name_of(System system) {
    return system == System::warp ? "end" : "pick";
}

std::string name_of(const YarnNumber& yarn) {
    return name_of(yarn.system) + " " + std::to_string(yarn.number + 1);
}

/// `picks 4, 10, 16 … 94`: all of a few, or the first of an even row and its last, or the first and how many
/// more.
std::string numbers_text(System system, const std::vector<std::size_t>& numbers) {
    std::string text = name_of(system) + (numbers.size() == 1 ? " " : "s ");
    const std::size_t told = numbers.size() <= most_numbers ? numbers.size() : most_numbers - 1;
    for (std::size_t k = 0; k < told; ++k) text += (k > 0 ? ", " : "") + std::to_string(numbers[k] + 1);
    if (told == numbers.size()) return text;
    bool even = true;
    for (std::size_t k = 2; k < numbers.size(); ++k)
        even = even && numbers[k] - numbers[k - 1] == numbers[1] - numbers[0];
    if (even) return text + " … " + std::to_string(numbers.back() + 1);
    return text + " and " + std::to_string(numbers.size() - told) + " more";
}

std::string ordinal(std::size_t number) {
    const bool teen = number % 100 / 10 == 1;
    const char* endings[]{"th", "st", "nd", "rd"};
    return std::to_string(number) + (teen || number % 10 > 3 ? "th" : endings[number % 10]);
}

std::string way_of(System system, double along) {
    if (system == System::weft) return along > 0 ? "towards the later picks" : "towards the earlier picks";
    return along > 0 ? "to the right" : "to the left";
}

/// The greatest part of a way across a yarn, in words.
std::string way_of(System system, const Vec3& way) {
    const double sideways = system == System::weft ? way.x() : way.y();
    if (std::abs(way.z()) > std::abs(sideways)) return way.z() > 0 ? "up" : "down";
    return way_of(system, sideways);
}

std::string list_end(std::size_t all) {
    return all > most_told ? "; and so on" : "";
}

std::optional<double> reported(const Yarns& yarns, const char* name) {
    const auto found = yarns.report.find(name);
    if (found == yarns.report.end() || !found->is_number()) return {};
    return found->get<double>();
}

/// What else is known of the rest: whether it is one that holds, and how far yarns are strained otherwise
/// than asked.
std::string rest_text(const Json& report) {
    std::string text;
    const bool rests = sim::part_of(report, "converged") == true;
    const Json curvature = rests ? sim::smallest_curvature(report) : Json(nullptr);
    if (curvature == "negative") text += "The rest is a SADDLE: a little push would lead on\n";
    if (curvature == "positive") text += "The energy curves up in every direction looked at: no small push was found that leads away from this rest\n";
    if (curvature == "unclear") text += "Whether the rest holds or is a saddle is not clear at this residual: go on to a smaller one to know\n";
    if (curvature == "not looked") text += "Nobody looked whether the rest holds or is a saddle\n";
    const Json strain = sim::part_of(report, "strain_deviation");
    std::string each;
    for (const char* system : {"warp", "weft"}) {
        const Json share = sim::part_of(strain, system);
        if (share.is_number())
            each += (each.empty() ? "" : ", ") + format(share.get<double>() < 0.1 ? "%.2g points in the " : "%.0f points in the ", 100 * share.get<double>()) +
                    system;
    }
    return each.empty() ? text : text + "Strain departs from what was asked for by at most " + each + "\n";
}

std::string run_text(const Yarns& yarns, const Inspection& inspection) {
    const auto converged = yarns.report.find("converged");
    const auto residual = reported(yarns, "residual");
    std::string text = "Nobody says whether it is at rest";
    if (converged != yarns.report.end() && converged->is_boolean())
        text = converged->get<bool>() ? "At rest" : "NOT at rest, so that all below may still change";
    if (residual) text += format(" (residual %.1e)", *residual);
    if (const Json goes_on = sim::part_of(yarns.report, "goes_on"); goes_on.is_string())
        text = "ON THE WAY to " + goes_on.get<std::string>() + ": these are yarns in fewer points, from before the others have relaxed. " + text;
    const auto such = [](const std::vector<ChangedCrossing>& crossings, const char* what) {
        return counted(crossings.size(), "crossing") + what + ", such as pick " + std::to_string(crossings.front().pick + 1) +
               " with end " + std::to_string(crossings.front().end + 1) + "\n";
    };
    if (inspection.changed.empty() && inspection.slid.empty())
        return text + "; every crossing lies as the card says\n" + rest_text(yarns.report);
    text += inspection.changed.empty() ? "; no yarn passed through another\n"
                                       : "\nCHANGED: " + such(inspection.changed, " no longer as the card says");
    if (!inspection.slid.empty()) text += "SLID: " + such(inspection.slid, " no longer where planned, open or not held");
    return text + rest_text(yarns.report);
}

std::string crimp_text(const char* system, const std::optional<Spread>& crimp) {
    if (!crimp) return std::string(system) + " not measured";
    std::string text = system + (" " + percent(crimp->mean));
    if (crimp->most - crimp->least >= 0.001)
        text += " (" + percent(crimp->least) + " to " + percent(crimp->most) + ")";
    return text;
}

std::string beam_text(const BeamTakeUp& beam) {
    const auto end = [](std::size_t number) { return "end " + std::to_string(number + 1); };
    std::string text = "  beam " + std::to_string(beam.beam + 1) + ": " + counted(beam.ends, "end") + ", " +
                       percent(beam.spread.mean);
    if (beam.ends == 1) return text + ", with no other to compare it with\n";
    if (beam.spread.most - beam.spread.least < 0.001) return text + ", all alike\n";
    text += ", from " + percent(beam.spread.least) + " (" + end(beam.spread.least_of) + ") to " +
            percent(beam.spread.most) + " (" + end(beam.spread.most_of) + ")";
    if (!beam.alike || *beam.alike < 0.001) return text + "\n";
    if (beam.alike_least_of == beam.spread.least_of && beam.alike_most_of == beam.spread.most_of)
        return text + ", though these two run alike\n";
    return text + "; " + end(beam.alike_least_of) + " and " + end(beam.alike_most_of) +
           " run alike and differ by " + format("%.1f points\n", 100 * *beam.alike);
}

/// `picks 21 to 60 of 80`, or without what the report of the run does not tell.
std::string stretch_text(const char* name, const std::optional<NumberSpan>& stretch,
                         const std::optional<std::size_t>& of) {
    if (!stretch) return std::string("no ") + name;
    return std::string(name) + " " + std::to_string((*stretch)[0] + 1) + " to " +
           std::to_string((*stretch)[1] + 1) + (of ? " of " + std::to_string(*of) : "");
}

/// How many the cloth has, and of these how many cross others, where some lie loose.
std::string all_text(std::size_t crossing, const std::optional<std::size_t>& all, const char* name) {
    if (!all || *all <= crossing) return counted(crossing, name);
    return counted(*all, name) + " (" + std::to_string(crossing) + " of them cross others)";
}

/// Which picks and ends of the cloth these are; of a whole cloth how many.
std::string part_text(const Inspection& inspection) {
    const InspectedPart& part = inspection.part;
    if (part.is_whole)
        return all_text(inspection.picks, part.cloth_picks, "pick") + " and " + all_text(inspection.ends, part.cloth_ends, "end");
    return "only a PART of the cloth, " + stretch_text("picks", part.picks, part.cloth_picks) + " and " +
           stretch_text("ends", part.ends, part.cloth_ends) + " (" +
           stretch_text("rows", part.rows, part.cloth_rows) + ", " +
           stretch_text("columns", part.columns, part.cloth_columns) + ")";
}

/// What frozen rims leave to be measured.
std::string rims_text(const Inspection& inspection) {
    const auto [rows, columns] = inspection.frozen_rims;
    if (!rows && !columns) return "";
    const std::string lines = rows && columns ? "rows and columns" : rows ? "rows" : "columns";
    std::string text = "Its rims were held as planned, so its " + std::to_string(disturbed_by_rim) +
                       " outermost " + lines + " are left out below: ";
    if (inspection.measured_picks == 0 || inspection.measured_ends == 0) return text + "nothing is left\n";
    return text + counted(inspection.measured_picks, "pick") + " and " +
           counted(inspection.measured_ends, "end") + " are left\n";
}

/// Whether a row has several picks, or a column several ends; otherwise the cloth is one layer.
bool is_layered(const Inspection& inspection) {
    const auto cells = [](const NumberSpan& span) { return span[1] - span[0] + 1; };
    return inspection.picks > cells(inspection.part.rows) || inspection.ends > cells(inspection.part.columns);
}

std::string measures_text(const Yarns& yarns, const Inspection& inspection) {
    std::string text = rims_text(inspection) + "Thickness " +
                       (inspection.thickness_mm ? mm(*inspection.thickness_mm) : "not measured");
    if (is_layered(inspection) && std::abs(inspection.settled - 1) >= 0.01)
        text += format(", its layers at %.0f %% of their planned distance", 100 * inspection.settled);
    text += "\nCrimp " + crimp_text("warp", inspection.warp_crimp) + ", " +
            crimp_text("weft", inspection.weft_crimp) + "\nTake-up" +
            (inspection.beams.empty() ? " not measured\n" : "\n");
    for (const BeamTakeUp& beam : inspection.beams) text += beam_text(beam);
    if (const auto overlap = reported(yarns, "max_overlap"); overlap && *overlap > 0)
        text += format("Yarns press into one another by at most %.0f %% of their width\n", 100 * *overlap);
    return text;
}

std::string sheets_text(const Inspection& inspection) {
    if (inspection.sheets.size() < 2) return "";
    std::string text = "FALLS APART into " + std::to_string(inspection.sheets.size()) +
                       " cloths that nothing binds, from below:\n";
    for (std::size_t k = 0; k < inspection.sheets.size() && k < most_told; ++k) {
        std::vector<std::size_t> picks, ends;
        for (const YarnNumber& yarn : inspection.sheets[k])
            (yarn.system == System::warp ? ends : picks).push_back(yarn.number);
        text += "  ";
        if (!picks.empty()) text += numbers_text(System::weft, picks);
        if (!ends.empty()) text += (picks.empty() ? "" : " with ") + numbers_text(System::warp, ends);
        text += "\n";
    }
    return text + (inspection.sheets.size() > most_told ? "  and more\n" : "");
}

/// Layers that lean in one system belong together: when one of them goes one way those beside it go the
/// other.
std::string leaning_text(const Inspection& inspection, System system) {
    std::string text;
    const char* row = system == System::weft ? "row" : "column";
    for (const LeaningLayer& layer : inspection.leaning) {
        if (layer.system != system) continue;
        const std::string name = ordinal(layer.layer + 1) + " " + name_of(system),
                          far = mm(std::abs(layer.mm)) + " " + way_of(system, layer.mm);
        if (!text.empty()) {
            text += "; with it the " + name + ", " + far;
            continue;
        }
        text = "LEANS: the " + name + " from below in each " + row + " (" +
               numbers_text(system, layer.numbers) + ") has gone " + far +
               format(", %.1f times its width, against those below and above it, ", layer.widths) +
               (layer.same_way == 1 ? "all the same way"
                                    : format("%.0f %% of them this way", 100 * layer.same_way));
    }
    return text.empty() ? text : text + "\n";
}

std::string bunched_text(const Inspection& inspection, System system) {
    std::vector<BunchedPair> pairs;
    for (const BunchedPair& pair : inspection.bunched) {
        if (pair.first.system == system) pairs.push_back(pair);
    }
    if (pairs.empty()) return "";
    const auto touching = static_cast<std::size_t>(std::ranges::count_if(pairs, &BunchedPair::touching));
    std::string text = "BUNCHED: " + counted(pairs.size(), "pair") + " of neighbouring " + name_of(system) +
                       "s have come together by half a width or more" +
                       (touching > 0 ? ", " + std::to_string(touching) + " of them touching" : "") + ": ";
    for (std::size_t k = 0; k < pairs.size() && k < most_told; ++k) {
        text += (k > 0 ? "; " : "") + std::to_string(pairs[k].first.number + 1) + " and " +
                std::to_string(pairs[k].second.number + 1) +
                (pairs[k].next_repeat ? " of the next repeat, " : ", ") + mm(pairs[k].mm) +
                " apart instead of " + mm(pairs[k].planned_mm);
    }
    return text + list_end(pairs.size()) + "\n";
}

std::string moved_text(const Inspection& inspection, System system) {
    std::vector<MovedYarn> moved;
    std::set<std::size_t> numbers;
    for (const MovedYarn& yarn : inspection.moved) {
        if (yarn.yarn.system == system && numbers.insert(yarn.yarn.number).second) moved.push_back(yarn);
    }
    if (moved.empty()) return "";
    const std::size_t all = system == System::warp ? inspection.measured_ends : inspection.measured_picks;
    std::string text = "MOVED by more than their width: " + std::to_string(moved.size()) + " of " +
                       counted(all, name_of(system)) + ": ";
    for (std::size_t k = 0; k < moved.size() && k < most_told; ++k) {
        const MovedYarn& yarn = moved[k];
        text += (k > 0 ? "; " : "") + name_of(yarn.yarn) + " " + mm(yarn.mm) + " " +
                way_of(system, yarn.way) + " at " +
                name_of(system == System::warp ? System::weft : System::warp) + " " +
                std::to_string(yarn.crossed + 1);
    }
    return text + list_end(moved.size()) + "\n";
}

std::string jammed_text(const Inspection& inspection, System system) {
    std::vector<JammedYarn> jammed;
    for (const JammedYarn& yarn : inspection.jammed) {
        if (yarn.yarn.system == system) jammed.push_back(yarn);
    }
    if (jammed.empty()) return "";
    const std::size_t all = system == System::warp ? inspection.measured_ends : inspection.measured_picks;
    const JammedYarn& worst = jammed.front();
    const std::string other = name_of(system == System::warp ? System::weft : System::warp);
    return "JAMMED: " + std::to_string(jammed.size()) + " of " + counted(all, name_of(system)) +
           " change sides somewhere without a straight piece left; tightest " + name_of(worst.yarn) +
           " between " + other + "s " + std::to_string(worst.between[0] + 1) + " and " +
           std::to_string(worst.between[1] + 1) + ", in " + std::to_string(worst.places) + " of its " +
           std::to_string(worst.of) + " changes\n";
}

}  // namespace

std::string inspection_text(const Yarns& yarns, const Inspection& inspection) {
    std::string text =
        on_one_line(yarns.title) + ": " + part_text(inspection) + ", " +
        format("%.1f mm along the ends, %.1f mm along the picks\n", yarns.size_mm[0], yarns.size_mm[1]);
    text += run_text(yarns, inspection) + measures_text(yarns, inspection);
    text += sim::starts_text(yarns.report) + sim::symmetry_text(yarns.report);
    std::string found = sheets_text(inspection);
    for (const System system : {System::weft, System::warp}) found += leaning_text(inspection, system);
    for (const System system : {System::weft, System::warp}) found += bunched_text(inspection, system);
    for (const System system : {System::weft, System::warp}) found += moved_text(inspection, system);
    for (const System system : {System::weft, System::warp}) found += jammed_text(inspection, system);
    return text +
           (found.empty() ? "Nothing leans, bunches, jams, or has moved by more than its width\n" : found);
}

}  // namespace weave
