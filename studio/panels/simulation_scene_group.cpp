#include <studio/panels/simulation_scene_group.hpp>

#include <QCheckBox>
#include <QComboBox>
#include <QFormLayout>
#include <QSignalBlocker>

#include <studio/panels/simulation_parameter_row.hpp>

namespace weave::studio {

namespace {

void fill_boundaries(QComboBox* box, const QString& name) {
    box->addItem(SceneGroup::tr("Repeats"), static_cast<int>(Boundary::periodic));
    box->addItem(SceneGroup::tr("Held as planned"), static_cast<int>(Boundary::frozen));
    box->addItem(SceneGroup::tr("Free"), static_cast<int>(Boundary::free));
    box->setAccessibleName(name);
    box->setToolTip(
        SceneGroup::tr("Repeats: the cloth goes on for ever (periodic). Held: its rim lies as planned. Free: "
                       "nothing holds it; ends that are fed at constant tension must be held or repeat."));
}

void choose(QComboBox* box, int value) {
    const QSignalBlocker quiet(box);
    box->setCurrentIndex(box->findData(value));
}

}  // namespace

SceneGroup::SceneGroup(QWidget* parent)
    : QGroupBox(tr("Rims and forces"), parent),
      m_friction(new ParameterRow({0, 1, false, 2, 0.05, {}}, this)),
      m_gravity(new QCheckBox(tr("&Gravity"), this)),
      m_boundary_x(new QComboBox(this)),
      m_boundary_y(new QComboBox(this)),
      m_weft_mode(new QComboBox(this)) {
    fill_boundaries(m_boundary_x, tr("First and last pick"));
    fill_boundaries(m_boundary_y, tr("Left and right edge"));
    m_weft_mode->addItem(tr("Each pick from edge to edge"), static_cast<int>(WeftMode::periodic));
    m_weft_mode->addItem(tr("Turns at the edge"), static_cast<int>(WeftMode::wraparound));
    m_weft_mode->setAccessibleName(tr("Weft"));
    m_weft_mode->setObjectName("weft_mode");
    m_weft_mode->setToolTip(
        tr("Whether each pick is a yarn of its own, or the picks of a feeder are one yarn that turns where "
           "an end catches it (wraparound)."));
    m_friction->name(tr("Friction"),
                     tr("Coefficient of friction between yarns (Coulomb): 0 is none; yarns are said to have "
                        "0.2 to 0.5, which was measured here (docs/simulation.md, Friction). Range 0 to 1."));
    m_gravity->setToolTip(
        tr("Whether the yarns' own weight pulls them down. It is off as a rule: tension is far greater."));
    // That of the weft keeps room for its words, below its name where the panel is narrow.
    for (QComboBox* box : {m_boundary_x, m_boundary_y})
        box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    auto* form = new QFormLayout(this);
    form->setRowWrapPolicy(QFormLayout::WrapLongRows);
    form->addRow(tr("Friction"), m_friction);
    form->addRow(m_gravity);
    form->addRow(tr("First and last pick"), m_boundary_x);
    form->addRow(tr("Left and right edge"), m_boundary_y);
    form->addRow(tr("Weft"), m_weft_mode);
    connect(m_friction, &ParameterRow::edited, this,
            [this](double, bool is_dragging) { Q_EMIT edited(is_dragging); });
    connect(m_gravity, &QCheckBox::toggled, this, [this] { Q_EMIT edited(false); });
    for (QComboBox* box : {m_boundary_x, m_boundary_y, m_weft_mode})
        connect(box, &QComboBox::currentIndexChanged, this, [this] { Q_EMIT edited(false); });
    set_scene({});
}

void SceneGroup::set_scene(const Scene& scene) {
    m_friction->set_value(scene.friction);
    const QSignalBlocker quiet(m_gravity);
    m_gravity->setChecked(scene.gravity);
    choose(m_boundary_x, static_cast<int>(scene.boundary_x));
    choose(m_boundary_y, static_cast<int>(scene.boundary_y));
    choose(m_weft_mode, static_cast<int>(scene.weft_mode));
}

void SceneGroup::put_into(Scene& scene) const {
    scene.friction = m_friction->value();
    scene.gravity = m_gravity->isChecked();
    scene.boundary_x = static_cast<Boundary>(m_boundary_x->currentData().toInt());
    scene.boundary_y = static_cast<Boundary>(m_boundary_y->currentData().toInt());
    scene.weft_mode = static_cast<WeftMode>(m_weft_mode->currentData().toInt());
}

}  // namespace weave::studio
