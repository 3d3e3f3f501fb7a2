#pragma once

#include <QString>
#include <QWidget>

class QDoubleSpinBox;
class QSlider;

namespace weave::studio {

/// The values that a parameter may have, as a person sees them.
struct ParameterRange {
    double least = 0, most = 1;
    bool is_ratio = false;  ///< the slider goes by factors, with 1 in its middle where the range allows
    int decimals = 2;
    double step = 0.1;
    QString unit;
};

/// A number as a spin box and a slider beside it. A value of a document that lies beyond the range shows as
/// it is.
class ParameterRow : public QWidget {
    Q_OBJECT
  public:
    explicit ParameterRow(const ParameterRange& range, QWidget* parent = nullptr);

    [[nodiscard]] double value() const;
    /// Shows a value; tells nobody.
    void set_value(double value);
    /// Also for the parts.
    void name(const QString& name, const QString& tool_tip);
    [[nodiscard]] QDoubleSpinBox* spin_box() const { return m_spin; }
    [[nodiscard]] QSlider* slider() const { return m_slider; }

  Q_SIGNALS:
    /// By the person's hand; while the slider is held it is being dragged, and told once more when it is let
    /// go.
    void edited(double value, bool is_dragging);

  private:
    [[nodiscard]] int place_of(double value) const;
    [[nodiscard]] double value_at(int place) const;
    void slide(int place);

    ParameterRange m_range;
    QDoubleSpinBox* m_spin;
    QSlider* m_slider;
    double m_given = 0, m_rounded = 0;  ///< the value that is shown, and as the box has it: nobody's edit shortens it
};

}  // namespace weave::studio
