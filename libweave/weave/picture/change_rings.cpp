#include <weave/picture/change_rings.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weave {

namespace {

// As shares of the grid's longer side. A whole picture is seen some 1,000 pixels long: changes that cover
// less than a square of 5 of them are easily missed, a ring of 22 with a line of 2 is not.
constexpr double seen_alone = 1.0 / 200, least_radius = 1.0 / 90, line_width = 1.0 / 500;
constexpr double smallest_radius = 12, thinnest_line = 3;  ///< pixels, on small pictures
constexpr double most_covered = 1.0 / 8;                   ///< of the grid, by more than a few rings
constexpr std::size_t few_rings = 12;

std::size_t bins_along(std::size_t pixels, double side) {
    return static_cast<std::size_t>(static_cast<double>(pixels) / side) + 1;
}

}  // namespace

void ChangeRings::Bin::cover(const Bin& other) {
    if (!used()) {
        *this = other;
        return;
    }
    area += other.area;
    left = std::min(left, other.left);
    right = std::max(right, other.right);
    top = std::min(top, other.top);
    bottom = std::max(bottom, other.bottom);
}

ChangeRings::ChangeRings(const Grid& grid)
    : m_grid(&grid),
      m_reach(std::max(smallest_radius, longest() * least_radius)),
      m_across(bins_along(grid.width(), m_reach)),
      m_down(bins_along(grid.height(), m_reach)),
      m_bins(m_across * m_down) {}

double ChangeRings::longest() const {
    return static_cast<double>(std::max(m_grid->width(), m_grid->height()));
}

double ChangeRings::line() const {
    return std::max(thinnest_line, longest() * line_width);
}

void ChangeRings::add(std::size_t row, std::size_t column) {
    const Rectangle box = m_grid->box(row, column);
    const auto bin_of = [this](double pixels, std::size_t bins) {
        return std::min(static_cast<std::size_t>(std::max(pixels, 0.0) / m_reach), bins - 1);
    };
    const std::size_t across = bin_of(box.x - m_grid->corner.x, m_across);
    const std::size_t down = bin_of(box.y - m_grid->corner.y, m_down);
    m_bins[down * m_across + across].cover(
        {box.width * box.height, box.x, box.x + box.width, box.y, box.y + box.height});
}

template <class Visit>
void ChangeRings::each_neighbour(std::size_t bin, Visit visit) const {
    const std::size_t across = bin % m_across, down = bin / m_across;
    for (std::size_t y = down == 0 ? 0 : down - 1; y <= std::min(down + 1, m_down - 1); ++y)
        for (std::size_t x = across == 0 ? 0 : across - 1; x <= std::min(across + 1, m_across - 1); ++x)
            visit(y * m_across + x);
}

bool ChangeRings::is_seen(std::size_t bin) const {
    const double side = longest() * seen_alone;
    double area = 0;
    each_neighbour(bin, [&](std::size_t near) { area += m_bins[near].area; });
    return area >= side * side;
}

std::vector<Ring> ChangeRings::rings() const {
    std::vector<Ring> rings;
    std::vector<bool> done(m_bins.size(), false);
    double covered = 0;
    for (std::size_t bin = 0; bin < m_bins.size(); ++bin) {
        if (!m_bins[bin].used() || done[bin] || is_seen(bin)) continue;
        Bin changes = m_bins[bin];
        each_neighbour(bin, [&](std::size_t near) {
            if (near <= bin || !m_bins[near].used() || done[near] || is_seen(near)) return;
            Bin both = changes;
            both.cover(m_bins[near]);
            if (std::max(both.right - both.left, both.bottom - both.top) > 2 * m_reach) return;
            changes = both;
            done[near] = true;
        });
        const double width = changes.right - changes.left, height = changes.bottom - changes.top;
        const double radius = std::max(m_reach, std::hypot(width, height) / 2 + 2 * line());
        rings.push_back({{changes.left + width / 2, changes.top + height / 2}, radius});
        covered += std::numbers::pi * radius * radius;
    }
    const double area = static_cast<double>(m_grid->width()) * static_cast<double>(m_grid->height());
    if (rings.size() > few_rings && covered > area * most_covered) return {};
    return rings;
}

}  // namespace weave
