#include <weave/picture/change_rings.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weave {

namespace {

// As shares of the grid's longer side. A whole picture is seen some 1,000 pixels long: a change of less than
// 10 of them is easily missed, a ring of 22 with a line of 2 is not.
constexpr double seen_alone = 1.0 / 100, least_radius = 1.0 / 90, line_width = 1.0 / 500;
constexpr double smallest_radius = 12, thinnest_line = 3;  ///< pixels, on small pictures
constexpr double most_covered = 1.0 / 8;                   ///< of the grid, by all rings

std::size_t bins_along(std::size_t pixels, double side) {
    return static_cast<std::size_t>(static_cast<double>(pixels) / side) + 1;
}

}  // namespace

void ChangeRings::Bin::cover(const Bin& other) {
    if (!used) {
        *this = other;
        return;
    }
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
    m_bins[down * m_across + across].cover({true, box.x, box.x + box.width, box.y, box.y + box.height});
}

/// All that lies in bins which touch one another.
ChangeRings::Bin ChangeRings::gathered(std::size_t first, std::vector<bool>& seen) const {
    Bin all;
    std::vector<std::size_t> open{first};
    seen[first] = true;
    while (!open.empty()) {
        const std::size_t bin = open.back(), across = bin % m_across, down = bin / m_across;
        open.pop_back();
        all.cover(m_bins[bin]);
        for (std::size_t y = down == 0 ? 0 : down - 1; y <= std::min(down + 1, m_down - 1); ++y) {
            for (std::size_t x = across == 0 ? 0 : across - 1; x <= std::min(across + 1, m_across - 1); ++x) {
                const std::size_t next = y * m_across + x;
                if (!m_bins[next].used || seen[next]) continue;
                seen[next] = true;
                open.push_back(next);
            }
        }
    }
    return all;
}

std::vector<Ring> ChangeRings::rings() const {
    std::vector<Ring> rings;
    std::vector<bool> seen(m_bins.size(), false);
    double covered = 0;
    for (std::size_t bin = 0; bin < m_bins.size(); ++bin) {
        if (!m_bins[bin].used || seen[bin]) continue;
        const Bin changes = gathered(bin, seen);
        const double width = changes.right - changes.left, height = changes.bottom - changes.top;
        if (std::max(width, height) >= longest() * seen_alone) continue;
        const double radius = std::max(m_reach, std::hypot(width, height) / 2 + 2 * line());
        rings.push_back({{changes.left + width / 2, changes.top + height / 2}, radius});
        covered += std::numbers::pi * radius * radius;
    }
    const double area = static_cast<double>(m_grid->width()) * static_cast<double>(m_grid->height());
    if (covered > area * most_covered) return {};
    return rings;
}

}  // namespace weave
