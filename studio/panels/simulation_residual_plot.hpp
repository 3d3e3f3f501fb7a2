#pragma once

#include <QWidget>

#include <cstddef>
#include <optional>
#include <studio/jobs/happenings.hpp>
#include <studio/panels/simulation_residual_scale.hpp>
#include <vector>

namespace weave::studio {

/// How the residual falls, step by step, on a logarithmic axis, with the line at which it is at rest. A
/// click, or the arrow keys, shows the value at a step.
class ResidualPlot : public QWidget {
    Q_OBJECT
  public:
    explicit ResidualPlot(QWidget* parent = nullptr);

    void clear();
    void add(const std::vector<ResidualPoint>& points);
    void set_goal(double goal);

    [[nodiscard]] const std::vector<ResidualPoint>& points() const { return m_points; }
    /// The point that is marked; nothing where none is.
    [[nodiscard]] std::optional<ResidualPoint> marked() const;
    [[nodiscard]] ResidualScale scale() const;
    [[nodiscard]] QSize sizeHint() const override;
    [[nodiscard]] QSize minimumSizeHint() const override;

  protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

  private:
    void mark_at(double x);
    void mark(std::optional<std::size_t> point);
    void thin_out();
    [[nodiscard]] QRectF foot(const ResidualScale& scale) const;
    void draw_grid(QPainter& painter, const ResidualScale& scale) const;
    void draw_goal(QPainter& painter, const ResidualScale& scale) const;
    void draw_curve(QPainter& painter, const ResidualScale& scale) const;
    void draw_mark(QPainter& painter, const ResidualScale& scale) const;
    [[nodiscard]] bool is_dark() const;

    std::vector<ResidualPoint> m_points;
    double m_goal = 0;
    std::optional<std::size_t> m_marked;
};

}  // namespace weave::studio
