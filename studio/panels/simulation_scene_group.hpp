#pragma once

#include <weave/design/scene.hpp>

#include <QGroupBox>

class QCheckBox;
class QComboBox;

namespace weave::studio {

class ParameterRow;

/// What the simulator needs to know of the cloth beside its yarns: friction, gravity, rims, the weft's way.
class SceneGroup : public QGroupBox {
    Q_OBJECT
  public:
    explicit SceneGroup(QWidget* parent = nullptr);

    /// Shows these; tells nobody.
    void set_scene(const Scene& scene);
    /// Puts what is chosen here into a scene.
    void put_into(Scene& scene) const;
    [[nodiscard]] ParameterRow* friction() const { return m_friction; }
    [[nodiscard]] QCheckBox* gravity() const { return m_gravity; }
    [[nodiscard]] QComboBox* boundary_x() const { return m_boundary_x; }
    [[nodiscard]] QComboBox* boundary_y() const { return m_boundary_y; }
    [[nodiscard]] QComboBox* weft_mode() const { return m_weft_mode; }

  Q_SIGNALS:
    void edited(bool is_dragging);

  private:
    ParameterRow* m_friction;
    QCheckBox* m_gravity;
    QComboBox *m_boundary_x, *m_boundary_y, *m_weft_mode;
};

}  // namespace weave::studio
