#pragma once

#include <QColor>
#include <QWidget>

#include <vector>

namespace weave::studio {

/// What the colours of a float map mean: lengths of floats, in stacks, of wefts above those of warps.
class FloatLegend : public QWidget {
    Q_OBJECT
  public:
    explicit FloatLegend(QWidget* parent = nullptr);

    /// Lengths of one colour, the same for both systems.
    struct Step {
        QString words;  ///< `1`, `4–5`, `≥ 16`
        QColor weft, warp;
    };
    [[nodiscard]] const std::vector<Step>& steps() const { return m_steps; }
    [[nodiscard]] QSize sizeHint() const override;
    [[nodiscard]] QSize minimumSizeHint() const override;

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    [[nodiscard]] int heading_width() const;
    std::vector<Step> m_steps;
};

}  // namespace weave::studio
