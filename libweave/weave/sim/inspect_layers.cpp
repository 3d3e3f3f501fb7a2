// The layers of a cloth: whether they lean, and where neighbours in a layer have come together.

#include <weave/sim/inspect_detail.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace weave::sim {

namespace {

/// Thin yarns with much room wander by their width and nobody minds: what leans has gone a good part of the
/// way to the next row as well.
constexpr double least_lean_widths = 1, least_lean_spacings = 0.4;
constexpr double least_bunch_widths = 0.5;
/// Two yarns touch if no more than this share of their width is between them.
constexpr double touching_share = 0.05;

using Row = std::vector<const Strand*>;  ///< lowest first

/// The rows (of picks) or columns (of ends) with as many strands, by their number along the cloth.
using Rows = std::map<long, Row>;

std::size_t rows_in(const InspectionSubject& subject, System system) {
    const Region& region = subject.yarns.region;
    return 1 + (system == System::weft ? region.last_row - region.first_row
                                       : region.last_column - region.first_column);
}

double spacing_mm(const InspectionSubject& subject, System system) {
    const double size = subject.yarns.size_mm[static_cast<std::size_t>(across(system))];
    return size / static_cast<double>(rows_in(subject, system));
}

/// Rows by how many strands they have: the same place in a row means the same layer only among those.
std::map<std::size_t, Rows> rows_by_size(const InspectionSubject& subject, System system) {
    const double spacing = spacing_mm(subject, system);
    std::map<std::size_t, Rows> sorted;
    if (!(spacing > 0)) return sorted;
    Rows rows;
    for (const Strand& strand : subject.strands) {
        if (strand.system == system)
            rows[std::lround(std::clamp(strand.planned[across(system)] / spacing, -1e9, 1e9))].push_back(
                &strand);
    }
    for (auto& [at, row] : rows) {
        std::ranges::stable_sort(row, {}, [](const Strand* strand) { return strand->planned.z(); });
        sorted[row.size()].emplace(at, std::move(row));
    }
    return sorted;
}

/// How far the strand at `layer` of a row stands off the line between those below and above it; nothing where
/// they lie in other sheets, which slide freely.
std::optional<double> lean(const Row& row, std::size_t layer, int axis) {
    const Strand &below = *row[layer - 1], &here = *row[layer], &above = *row[layer + 1];
    if (below.sheet != here.sheet || above.sheet != here.sheet) return {};
    const double height = above.planned.z() - below.planned.z();
    const double share = height > 1e-9 ? (here.planned.z() - below.planned.z()) / height : 0.5;
    return here.moved[axis] - (1 - share) * below.moved[axis] - share * above.moved[axis];
}

void find_leaning(const InspectionSubject& subject, System system, std::size_t layers, const Rows& rows,
                  Inspection& inspection) {
    for (std::size_t layer = 1; layer + 1 < layers; ++layer) {
        LeaningLayer found{.system = system, .layer = layer, .of = layers, .numbers = {}};
        double sum = 0, width = 0;
        std::size_t forward = 0;
        for (const auto& [at, row] : rows) {
            const std::optional<double> mm = lean(row, layer, across(system));
            if (!mm) continue;
            sum += *mm;
            forward += *mm > 0 ? 1 : 0;
            width += subject.width_mm(*row[layer]);
            found.numbers.push_back(row[layer]->number);
        }
        const auto count = static_cast<double>(found.numbers.size());
        if (count < 2) continue;
        found.mm = sum / count;
        found.widths = std::abs(sum) / width;
        found.same_way =
            (found.mm > 0 ? static_cast<double>(forward) : count - static_cast<double>(forward)) / count;
        if (found.widths > least_lean_widths &&
            std::abs(found.mm) > least_lean_spacings * spacing_mm(subject, system))
            inspection.leaning.push_back(std::move(found));
    }
}

class Bunching {
  public:
    Bunching(const InspectionSubject& subject, System system, Inspection& inspection)
        : m_subject(subject), m_axis(across(system)), m_inspection(inspection) {}

    void look(const Row& row, const Row& next, double repeat_mm) {
        for (std::size_t layer = 0; layer < row.size(); ++layer) look(*row[layer], *next[layer], repeat_mm);
    }

  private:
    void look(const Strand& a, const Strand& b, double repeat_mm) {
        if (a.sheet != b.sheet) return;
        const double planned = b.planned[m_axis] + repeat_mm - a.planned[m_axis];
        const Vec3 apart = b.planned + b.moved - a.planned - a.moved;
        const double now = std::hypot(apart[m_axis] + repeat_mm, apart.z());
        const double width = (m_subject.width_mm(a) + m_subject.width_mm(b)) / 2;
        if (planned - now <= least_bunch_widths * width) return;
        const bool touching = now < (1 + touching_share) * width;
        m_inspection.bunched.push_back(
            {{a.system, a.number}, {b.system, b.number}, planned, now, touching, repeat_mm > 0});
    }
    const InspectionSubject& m_subject;
    int m_axis;
    Inspection& m_inspection;
};

void find_bunched(const InspectionSubject& subject, System system, const Rows& rows, Inspection& inspection) {
    Bunching bunching(subject, system, inspection);
    const auto axis = static_cast<std::size_t>(across(system));
    for (auto row = rows.begin(); row != rows.end(); ++row) {
        const auto next = std::next(row);
        if (next != rows.end() && next->first == row->first + 1) bunching.look(row->second, next->second, 0);
    }
    const auto whole = static_cast<long>(rows_in(subject, system));
    if (subject.yarns.is_periodic[axis] && rows.size() > 1 &&
        rows.rbegin()->first - rows.begin()->first == whole - 1)
        bunching.look(rows.rbegin()->second, rows.begin()->second, subject.yarns.size_mm[axis]);
}

}  // namespace

void find_layers(const InspectionSubject& subject, Inspection& inspection) {
    for (const System system : {System::weft, System::warp}) {
        for (const auto& [layers, rows] : rows_by_size(subject, system)) {
            find_leaning(subject, system, layers, rows, inspection);
            find_bunched(subject, system, rows, inspection);
        }
    }
    std::ranges::stable_sort(inspection.leaning, std::greater{}, &LeaningLayer::widths);
    std::ranges::stable_sort(inspection.bunched, {}, &BunchedPair::mm);
}

}  // namespace weave::sim
