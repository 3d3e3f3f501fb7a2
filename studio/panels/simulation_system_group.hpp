#pragma once

#include <weave/block/stack.hpp>
#include <weave/design/scene.hpp>

#include <QGroupBox>

class QCheckBox;

namespace weave::studio {

class ParameterRow;

/// Strain, stiffness and radius of the warp or of the weft.
class SystemGroup : public QGroupBox {
    Q_OBJECT
  public:
    explicit SystemGroup(System system, QWidget* parent = nullptr);

    /// Shows these; tells nobody.
    void set_values(const SystemScene& values);
    [[nodiscard]] const SystemScene& values() const { return m_values; }
    [[nodiscard]] ParameterRow* strain() const { return m_strain; }
    [[nodiscard]] ParameterRow* stiffness() const { return m_stiffness; }
    [[nodiscard]] ParameterRow* radius() const { return m_radius; }
    /// Of the weft: whether it is fed at constant tension instead of being cut to length. Null for the warp,
    /// which always is.
    [[nodiscard]] QCheckBox* is_fed() const { return m_is_fed; }

  Q_SIGNALS:
    void edited(bool is_dragging);

  private:
    void feed(bool is_fed);

    System m_system;
    SystemScene m_values;
    ParameterRow *m_strain, *m_stiffness, *m_radius;
    QCheckBox* m_is_fed = nullptr;
};

/// The values that a system has where its scene does not say: what a run is led to when an edit takes them
/// away.
SystemScene with_usual_values(const SystemScene& values, System system);

}  // namespace weave::studio
