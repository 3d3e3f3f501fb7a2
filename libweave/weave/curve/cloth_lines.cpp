#include <weave/curve/cloth_lines.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace weave {

namespace {

/// Yarns of neighbouring lines are led aside by at most this share of the spacing of lines.
constexpr double share_of_line = 0.25;
/// Picks this many times as long as straight ones settle before they are laid.
constexpr double steep = 1.4;
/// Key points of lines that are kept: some 16 MB of rows and as much of columns.
constexpr std::size_t most_kept_keys = std::size_t{1} << 20;

double scaled(double radius_mm, const SystemScene& scene) {
    return radius_mm * scene.radius_scale.value_or(1);
}

class Mean {
  public:
    void add(double value) {
        m_sum += value;
        ++m_count;
        m_least = m_count == 1 ? value : std::min(m_least, value);
    }
    [[nodiscard]] double mean() const { return m_count == 0 ? 0 : m_sum / static_cast<double>(m_count); }
    [[nodiscard]] double least() const { return m_least; }
    [[nodiscard]] bool is_empty() const { return m_count == 0; }

  private:
    double m_sum = 0, m_least = 0;
    std::size_t m_count = 0;
};

const YarnType& yarn_of(const Design& design, std::uint32_t feeder) {
    return design.weft.yarns.at(design.weft.feeders.at(feeder).yarn);
}

ClothRadii radii_of(const Design& design, const Block& block, const std::vector<Pick>& picks) {
    Mean warps, wefts;
    for (std::size_t end = 0; end < block.ends(); ++end) {
        warps.add(scaled(yarn_of_end(design, end).radius_mm, design.scene.warp));
    }
    for (const Pick& pick : picks) {
        for (const std::uint32_t feeder : pick.feeders) {
            wefts.add(scaled(yarn_of(design, feeder).radius_mm, design.scene.weft));
        }
    }
    const double thinnest = wefts.is_empty()   ? warps.least()
                            : warps.is_empty() ? wefts.least()
                                               : std::min(warps.least(), wefts.least());
    return {warps.mean(), wefts.mean(), thinnest};
}

}  // namespace

ClothLines::Places::Places(const Block& block) : m_block(block) {
    for (const Stack& stack : block.stacks()) {
        m_wefts.push_back(stack.positions(System::weft));
        m_warps.push_back(stack.positions(System::warp));
    }
}

std::size_t ClothLines::Places::of_pick(std::size_t pick, std::size_t row, std::size_t column) const {
    return m_wefts[m_block.cells(row)[column]][pick - m_block.first_pick(row)];
}

std::size_t ClothLines::Places::of_end(std::size_t end, std::size_t row, std::size_t column) const {
    return m_warps[m_block.cells(row)[column]][end - m_block.first_end(column)];
}

bool ClothLines::Places::is_loose(std::size_t place, std::size_t row, std::size_t column) const {
    return m_block.stack(row, column).slots()[place].is_loose();
}

ClothLines::Leads ClothLines::Kept::find(std::size_t line) const {
    const auto found = m_lines.find(line);
    return found == m_lines.end() ? nullptr : found->second;
}

std::size_t ClothLines::Kept::keys_of(const std::vector<Lead>& leads) {
    std::size_t keys = 0;
    for (const Lead& lead : leads) keys += lead.level.size();
    return keys;
}

void ClothLines::Kept::forget(std::size_t line) {
    const auto found = m_lines.find(line);
    if (found == m_lines.end()) return;
    m_keys -= keys_of(*found->second);
    m_lines.erase(found);
}

ClothLines::Leads ClothLines::Kept::keep(std::size_t line, std::vector<Lead> leads) {
    const std::size_t keys = keys_of(leads);
    if (m_keys + keys > most_kept_keys) {
        m_lines.clear();
        m_keys = 0;
    }
    m_keys += keys;
    return m_lines[line] = std::make_shared<const std::vector<Lead>>(std::move(leads));
}

ClothLines::ClothLines(const Design& design, const Block& block, const CurveOptions& options)
    : m_block(block),
      m_picks(pick_table(design, block)),
      m_places(block),
      m_radii(radii_of(design, block, m_picks)),
      m_wraps(options.weft_mode.value_or(design.scene.weft_mode) == WeftMode::wraparound),
      m_row_effort(block.rows(), 0),
      m_row_way(block.rows()),
      m_column_way(block.columns()) {
    measure(design, options);
    const bool repeats = design.scene.boundary_x == Boundary::periodic;
    m_wefts = m_wraps ? wrapped_parts(block, m_picks, repeats) : straight_parts(block, m_picks);
    if (options.region) m_wefts = cut(m_wefts, m_frame.region);
    if (wefts_climb()) m_settled.emplace(block, m_frame.region, LevelSpacing{m_frame.dx_mm, m_frame.dy_mm, m_frame.is_periodic});
}

void ClothLines::measure(const Design& design, const CurveOptions& options) {
    const Scene& scene = design.scene;
    const double columns = static_cast<double>(m_block.columns()), ends = static_cast<double>(m_block.ends());
    m_frame.dx_mm = scene.dx_mm.value_or(10 / design.weft.density_picks_per_cm);
    m_frame.dy_mm = scene.dy_mm.value_or(10 * ends / columns / design.warp.density_ends_per_cm);
    m_frame.dz_mm = scene.dz_mm.value_or(m_radii.warp_mm + m_radii.weft_mm);
    m_frame.region = options.region.value_or(Region{0, m_block.rows() - 1, 0, m_block.columns() - 1});
    m_frame.size_mm = {static_cast<double>(rows()) * m_frame.dx_mm, static_cast<double>(this->columns()) * m_frame.dy_mm};
    if (options.region) return;
    m_frame.is_periodic = {scene.boundary_x == Boundary::periodic, scene.boundary_y == Boundary::periodic && !m_wraps};
}

double ClothLines::level_of(const WeftPart& part, std::size_t column) const {
    const double level = m_settled ? m_settled->of_pick(part.pick, column)
                                   : static_cast<double>(m_places.of_pick(part.pick, part.row, column));
    // Two wefts of one pick share its slot, so they are a part of a slot apart, however thick slots are.
    return level + part.offset * (m_settled ? settled_gap : 1);
}

double ClothLines::level_of_end(std::size_t end, std::size_t row, std::size_t column) const {
    return m_settled ? m_settled->of_end(end, row) : static_cast<double>(m_places.of_end(end, row, column));
}

bool ClothLines::is_loose_pick(std::size_t pick, std::size_t row, std::size_t column) const {
    return m_places.is_loose(m_places.of_pick(pick, row, column), row, column);
}

bool ClothLines::is_loose_end(std::size_t end, std::size_t row, std::size_t column) const {
    return m_places.is_loose(m_places.of_end(end, row, column), row, column);
}

bool ClothLines::is_loose_part(std::size_t part) const {
    const WeftPart& p = wefts().parts[part];
    for (std::size_t column = p.first_column; column <= p.last_column; ++column) {
        if (!is_loose_pick(p.pick, p.row, column)) return false;
    }
    return true;
}

bool ClothLines::is_over(std::size_t pick, std::size_t end, std::size_t row, std::size_t column) const {
    return m_places.of_pick(pick, row, column) > m_places.of_end(end, row, column);
}

/// Whether picks, laid in their slots, run so steeply up and down that they would be far longer than what is woven.
bool ClothLines::wefts_climb() const {
    double way = 0, straight = 0;
    for (const WeftPart& part : m_wefts.parts) {
        for (std::size_t column = part.first_column; column < part.last_column; ++column) {
            const double rise = (level_of(part, column + 1) - level_of(part, column)) * m_frame.dz_mm;
            way += std::hypot(m_frame.dy_mm, rise);
            straight += m_frame.dy_mm;
        }
    }
    return way > steep * straight;
}

std::size_t ClothLines::first_part(std::size_t row) const {
    const auto at = std::ranges::lower_bound(m_wefts.parts, row, {}, &WeftPart::row);
    return static_cast<std::size_t>(at - m_wefts.parts.begin());
}

ClothLines::Leads ClothLines::row(std::size_t row) const {
    if (Leads kept = m_kept_rows.find(row)) return kept;
    const LineSpacing spacing{m_frame.is_periodic[1], m_frame.dy_mm, m_frame.dz_mm, 2 * m_radii.weft_mm, share_of_line * m_frame.dx_mm};
    std::vector<LineYarn> yarns;
    for (std::size_t k = first_part(row); k < m_wefts.parts.size() && m_wefts.parts[k].row == row; ++k) {
        const WeftPart& part = m_wefts.parts[k];
        LineYarn yarn{part.first_column, {}};
        for (std::size_t column = part.first_column; column <= part.last_column; ++column) yarn.levels.push_back(level_of(part, column));
        yarns.push_back(std::move(yarn));
    }
    std::optional<LineWay>& way = m_row_way[row];
    if (!way) way = find_way(yarns, spacing, m_row_effort[row]);
    return m_kept_rows.keep(row, leads_along(yarns, spacing, *way));
}

ClothLines::Leads ClothLines::column(std::size_t column) const {
    if (Leads kept = m_kept_columns.find(column)) return kept;
    const LineSpacing spacing{m_frame.is_periodic[0], m_frame.dx_mm, m_frame.dz_mm, 2 * m_radii.warp_mm, share_of_line * m_frame.dy_mm};
    std::vector<LineYarn> yarns;
    for (std::size_t end = m_block.first_end(column); end < m_block.first_end(column + 1); ++end) {
        LineYarn yarn;
        for (std::size_t row = m_frame.region.first_row; row <= m_frame.region.last_row; ++row) yarn.levels.push_back(level_of_end(end, row, column));
        yarns.push_back(std::move(yarn));
    }
    std::optional<LineWay>& way = m_column_way[column];
    if (!way) way = find_way(yarns, spacing);
    return m_kept_columns.keep(column, leads_along(yarns, spacing, *way));
}

bool ClothLines::lead_further(std::size_t row) {
    if (m_row_effort[row] == most_effort) return false;
    ++m_row_effort[row];
    forget(row);
    return true;
}

void ClothLines::forget(std::size_t row) {
    m_kept_rows.forget(row);
    m_row_way[row].reset();
}

void ClothLines::set_efforts(std::vector<std::size_t> efforts) {
    for (std::size_t row = 0; row < efforts.size(); ++row) {
        if (efforts[row] != m_row_effort[row]) forget(row);
    }
    m_row_effort = std::move(efforts);
}

}  // namespace weave
