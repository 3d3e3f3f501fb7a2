// Which part of a cloth is looked over, and what of it a frozen rim leaves undisturbed.

#include <weave/sim/inspect_detail.hpp>
#include <weave/sim/report_words.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace weave::sim {

namespace {

std::optional<std::size_t> count_in(const Json& object, const char* name) {
    const Json part = part_of(object, name);
    if (!part.is_number_integer()) return {};
    const auto count = part.get<std::int64_t>();
    return count > 0 ? std::optional(static_cast<std::size_t>(count)) : std::nullopt;
}

void widen(std::optional<NumberSpan>& stretch, std::size_t number) {
    if (!stretch) stretch = NumberSpan{number, number};
    *stretch = {std::min((*stretch)[0], number), std::max((*stretch)[1], number)};
}

/// Rows of the piece (axis 0), or columns (axis 1).
NumberSpan cells(const Yarns& yarns, std::size_t axis) {
    const Region& region = yarns.region;
    return axis == 0 ? NumberSpan{region.first_row, region.last_row}
                     : NumberSpan{region.first_column, region.last_column};
}

double cell_mm(const Yarns& yarns, std::size_t axis) {
    const auto [first, last] = cells(yarns, axis);
    return yarns.size_mm[axis] / static_cast<double>(last - first + 1);
}

}  // namespace

InspectedPart piece_of(const Yarns& yarns) {
    InspectedPart part;
    part.rows = cells(yarns, 0);
    part.columns = cells(yarns, 1);
    part.cloth_rows = yarns.cloth_rows;
    part.cloth_columns = yarns.cloth_columns;
    part.is_whole = part.rows[0] == 0 && part.columns[0] == 0 && part.rows[1] + 1 >= yarns.cloth_rows &&
                    part.columns[1] + 1 >= yarns.cloth_columns;
    for (const Crossing& crossing : yarns.crossings) {
        widen(part.picks, crossing.pick);
        widen(part.ends, crossing.end);
    }
    const Json of = part_of(part_of(yarns.report, "coverage"), "of");
    part.cloth_picks = count_in(of, "picks");
    part.cloth_ends = count_in(of, "ends");
    return part;
}

std::array<bool, 2> frozen_rims(const Yarns& yarns) {
    std::array<bool, 2> frozen{};
    const bool cut = !piece_of(yarns).is_whole;
    for (std::size_t axis = 0; axis < 2; ++axis)
        frozen[axis] =
            !yarns.is_periodic[axis] &&
            (cut || plan_choice(yarns.report, axis == 0 ? "boundary x" : "boundary y") == "frozen");
    return frozen;
}

std::vector<char> undisturbed(const Yarns& yarns, const std::vector<CrossingPlace>& places,
                              const std::array<bool, 2>& frozen) {
    std::vector<char> counted(places.size(), 1);
    for (std::size_t axis = 0; axis < 2; ++axis) {
        if (!frozen[axis]) continue;
        const auto [first, last] = cells(yarns, axis);
        const double cell = cell_mm(yarns, axis), aside = static_cast<double>(disturbed_by_rim) - 0.5;
        const double low = (static_cast<double>(first) + aside) * cell,
                     high = (static_cast<double>(last) - aside) * cell;
        for (std::size_t i = 0; i < places.size(); ++i) {
            // An end is planned within its column and a pick within its row, but along themselves they are
            // exact.
            const double at = axis == 0 ? places[i].planned_warp.x() : places[i].planned_weft.y();
            if (!(at > low && at < high)) counted[i] = 0;
        }
    }
    return counted;
}

std::vector<MeasuredStretch> measured_stretches(const InspectionSubject& subject) {
    const Yarns& yarns = subject.yarns;
    std::vector<MeasuredStretch> stretches;
    if (!subject.frozen_rims[0] && !subject.frozen_rims[1]) {
        for (std::size_t y = 0; y < yarns.yarns.size(); ++y)
            stretches.push_back({y, 0, static_cast<double>(yarns.yarns[y].spline.segments())});
        return stretches;
    }
    for (const Strand& strand : subject.strands) {
        const bool warp = strand.system == System::warp;
        const auto along = static_cast<std::size_t>(warp ? 0 : 1);
        const Spline& spline = subject.yarn_of(strand).spline;
        if (spline.is_periodic && !subject.frozen_rims[along]) {
            stretches.push_back({strand.yarn, 0, static_cast<double>(spline.segments())});
            continue;
        }
        double from = std::numeric_limits<double>::max(), to = 0, low = from, high = -from;
        for (const std::size_t i : strand.crossings) {
            const CrossingPlace& place = subject.places[i];
            if (!place.spot) continue;
            const double at = warp ? place.spot->warp_at : place.spot->weft_at,
                         planned = warp ? place.planned_warp.x() : place.planned_weft.y();
            from = std::min(from, at);
            to = std::max(to, at);
            low = std::min(low, planned);
            high = std::max(high, planned);
        }
        if (high - low > (static_cast<double>(least_measured) - 1.5) * cell_mm(yarns, along))
            stretches.push_back({strand.yarn, from, to});
    }
    return stretches;
}

}  // namespace weave::sim
