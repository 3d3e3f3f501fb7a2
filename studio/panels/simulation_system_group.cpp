#include <studio/panels/simulation_system_group.hpp>

#include <weave/sim/plan.hpp>

#include <QCheckBox>
#include <QFormLayout>
#include <QSignalBlocker>

#include <studio/panels/simulation_parameter_row.hpp>

namespace weave::studio {

namespace {

// What the catalogue of extremes (libweave/weave/sim/extremes.cpp, `weave bench stability`) brings to rest,
// jumps while it relaxes included: S from 1 to 1.5, EA and EI by 1/1000 and 1000, radii by 0.5 and 1.5.
// Beyond, nobody has looked.
constexpr double most_strain_percent = 50, least_stiffness = 0.001, most_stiffness = 1000, least_radius = 0.5,
                 most_radius = 1.5;

double percent_of(double strain) {
    return 100 * (strain - 1);
}

}  // namespace

SystemScene with_usual_values(const SystemScene& values, System system) {
    SystemScene whole = values;
    if (system == System::warp) whole.strain = values.strain.value_or(sim::usual_strain);
    whole.stiffness_scale = values.stiffness_scale.value_or(1);
    whole.radius_scale = values.radius_scale.value_or(1);
    return whole;
}

SystemGroup::SystemGroup(System system, QWidget* parent)
    : QGroupBox(system == System::warp ? tr("Warp (ends)") : tr("Weft (picks)"), parent),
      m_system(system),
      m_strain(new ParameterRow({0, most_strain_percent, false, 2, 0.1, tr(" %")}, this)),
      m_stiffness(new ParameterRow({least_stiffness, most_stiffness, true, 3, 0.1, tr(" ×")}, this)),
      m_radius(new ParameterRow({least_radius, most_radius, true, 2, 0.05, tr(" ×")}, this)) {
    auto* form = new QFormLayout(this);
    form->setRowWrapPolicy(QFormLayout::WrapLongRows);
    if (system == System::weft) {
        m_is_fed = new QCheckBox(tr("Fed at constant &tension"), this);
        m_is_fed->setToolTip(
            tr("Off: each pick is cut to the length that the loom inserts. On: it is pulled through until it "
               "has the target strain, as ends are.\nTakes effect when the simulation starts again."));
        form->addRow(m_is_fed);
        connect(m_is_fed, &QCheckBox::toggled, this, &SystemGroup::feed);
    }
    form->addRow(tr("Target strain"), m_strain);
    form->addRow(tr("Stiffness"), m_stiffness);
    form->addRow(tr("Yarn radius"), m_radius);
    m_strain->name(tr("Target strain"), tr("How far the yarn is stretched by its tension at rest. 0 to 50 %: "
                                           "the range in which the simulator was tried to its limits (weave "
                                           "bench stability).\nA change while it runs is led in by and by."));
    m_stiffness->name(tr("Stiffness"),
                      tr("Times the yarn's own stiffness in stretching and bending. 0.001 to 1000: the range "
                         "in which the simulator was tried to its limits (weave bench stability).\nA change "
                         "while it runs is led in by and by."));
    m_radius->name(tr("Yarn radius"),
                   tr("Times the yarn's own radius. 0.5 to 1.5: the range in which the simulator was tried "
                      "to its limits (weave bench stability).\nA change while it runs is led in by and by."));
    connect(m_strain, &ParameterRow::edited, this, [this](double value, bool is_dragging) {
        m_values.strain = 1 + value / 100;
        Q_EMIT edited(is_dragging);
    });
    connect(m_stiffness, &ParameterRow::edited, this, [this](double value, bool is_dragging) {
        m_values.stiffness_scale = value;
        Q_EMIT edited(is_dragging);
    });
    connect(m_radius, &ParameterRow::edited, this, [this](double value, bool is_dragging) {
        m_values.radius_scale = value;
        Q_EMIT edited(is_dragging);
    });
    set_values({});
}

void SystemGroup::set_values(const SystemScene& values) {
    m_values = values;
    m_strain->set_value(percent_of(values.strain.value_or(sim::usual_strain)));
    m_stiffness->set_value(values.stiffness_scale.value_or(1));
    m_radius->set_value(values.radius_scale.value_or(1));
    if (m_is_fed == nullptr) return;
    const QSignalBlocker quiet(m_is_fed);
    m_is_fed->setChecked(values.strain.has_value());
    m_strain->setEnabled(values.strain.has_value());
}

void SystemGroup::feed(bool is_fed) {
    m_values.strain.reset();
    if (is_fed) m_values.strain = sim::usual_strain;
    set_values(SystemScene(m_values));
    Q_EMIT edited(false);
}

}  // namespace weave::studio
