#include <studio/panels/simulation_residual_scale.hpp>

#include <algorithm>
#include <cmath>

namespace weave::studio {

namespace {

constexpr double least_shown = 1e-15, most_shown = 1e15;

double decade(double residual) {
    return std::log10(std::clamp(residual, least_shown, most_shown));
}

/// The smallest of 1, 2, 5, 10, 20 … that is not below `least`.
std::uint64_t round_step(double least) {
    for (std::uint64_t power = 1;; power *= 10) {
        for (const std::uint64_t digit : {1, 2, 5}) {
            if (static_cast<double>(digit * power) >= least) return digit * power;
        }
    }
}

}  // namespace

ResidualScale::ResidualScale(const QRectF& area, std::uint64_t last_step, double least, double most)
    : m_area(area),
      m_last_step(std::max<std::uint64_t>(1, last_step)),
      m_lowest(static_cast<int>(std::floor(decade(least) + 1e-9))),
      m_highest(static_cast<int>(std::ceil(decade(most) - 1e-9))) {
    m_highest = std::max(m_highest, m_lowest + 1);
}

double ResidualScale::x_of(double step) const {
    return m_area.left() + m_area.width() * step / static_cast<double>(m_last_step);
}

double ResidualScale::y_of(double residual) const {
    const double share = (decade(residual) - m_lowest) / (m_highest - m_lowest);
    return m_area.bottom() - m_area.height() * std::clamp(share, 0.0, 1.0);
}

double ResidualScale::step_at(double x) const {
    return std::clamp((x - m_area.left()) / m_area.width(), 0.0, 1.0) * static_cast<double>(m_last_step);
}

std::vector<int> ResidualScale::decades(int most) const {
    const int every = std::max(1, (m_highest - m_lowest + most - 1) / std::max(1, most));
    std::vector<int> list;
    for (int one = m_lowest; one <= m_highest; one += every) list.push_back(one);
    return list;
}

std::vector<std::uint64_t> ResidualScale::steps(int most) const {
    const std::uint64_t every = round_step(static_cast<double>(m_last_step) / std::max(1, most));
    std::vector<std::uint64_t> list;
    for (std::uint64_t step = 0; step <= m_last_step; step += every) list.push_back(step);
    return list;
}

}  // namespace weave::studio
