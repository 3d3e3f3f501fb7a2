#include <weave/sim/pace.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace weave::sim {

void Pace::add(double seconds, double residual) {
    if (!(residual > 0)) return;
    constexpr double another_run = 3;  // e-folds
    const double log_residual = std::log(residual);
    if (!m_past.empty() && log_residual > m_past.back().log_residual + another_run) m_past.clear();
    // Enough for the last third, however long it lasts: every second one goes when there are many.
    constexpr std::size_t most = 4096;
    if (m_past.size() >= most) {
        for (std::size_t k = 0; 2 * k < m_past.size(); ++k) m_past[k] = m_past[2 * k];
        m_past.resize(m_past.size() / 2);
    }
    m_past.push_back({seconds, log_residual});
}

std::optional<double> Pace::seconds_left() const {
    if (m_past.size() < 2) return {};
    const Past& now = m_past.back();
    const double third = m_past.front().seconds + (now.seconds - m_past.front().seconds) * 2 / 3;
    const auto then = std::ranges::find_if(m_past, [&](const Past& past) { return past.seconds >= third; });
    const double fell = then->log_residual - now.log_residual;
    constexpr double enough = 0.5;  // e-folds; from less than that estimates jump
    if (!(fell > enough)) return {};
    return std::max(0.0, (now.log_residual - std::log(m_goal)) / fell * (now.seconds - then->seconds));
}

}  // namespace weave::sim
