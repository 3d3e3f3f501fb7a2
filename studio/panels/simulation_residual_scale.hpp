#pragma once

#include <QRectF>

#include <cstdint>
#include <vector>

namespace weave::studio {

/// Where steps and residuals lie on a plot: steps evenly from 0 at the left, residuals by their logarithm in
/// whole decades.
class ResidualScale {
  public:
    /// `least` and `most` are residuals that must show, above 0.
    ResidualScale(const QRectF& area, std::uint64_t last_step, double least, double most);

    [[nodiscard]] double x_of(double step) const;
    /// What lies beyond the plot is drawn at its rim.
    [[nodiscard]] double y_of(double residual) const;
    [[nodiscard]] double step_at(double x) const;

    [[nodiscard]] int lowest_decade() const { return m_lowest; }
    [[nodiscard]] int highest_decade() const { return m_highest; }
    /// Decades to be labelled, at most so many.
    [[nodiscard]] std::vector<int> decades(int most) const;
    /// Round numbers of steps to be labelled, from 0, at most so many.
    [[nodiscard]] std::vector<std::uint64_t> steps(int most) const;
    [[nodiscard]] const QRectF& area() const { return m_area; }

  private:
    QRectF m_area;
    std::uint64_t m_last_step;
    int m_lowest, m_highest;
};

}  // namespace weave::studio
