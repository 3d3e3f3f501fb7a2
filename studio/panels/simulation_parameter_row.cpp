#include <studio/panels/simulation_parameter_row.hpp>

#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QSignalBlocker>
#include <QSlider>

#include <algorithm>
#include <cmath>

namespace weave::studio {

namespace {

constexpr int places = 1000;

}  // namespace

ParameterRow::ParameterRow(const ParameterRange& range, QWidget* parent)
    : QWidget(parent),
      m_range(range),
      m_spin(new QDoubleSpinBox(this)),
      m_slider(new QSlider(Qt::Horizontal, this)) {
    auto* line = new QHBoxLayout(this);
    line->setContentsMargins(0, 0, 0, 0);
    line->addWidget(m_slider, 1);
    line->addWidget(m_spin);
    m_spin->setDecimals(range.decimals);
    m_spin->setRange(range.least, range.most);
    m_spin->setSingleStep(range.step);
    m_spin->setSuffix(range.unit);
    m_spin->setKeyboardTracking(false);
    m_spin->setMinimumWidth(8 * fontMetrics().height());  // so that rows stand in line
    if (range.is_ratio) m_spin->setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
    m_slider->setRange(0, places);
    m_slider->setPageStep(places / 20);
    connect(m_slider, &QSlider::valueChanged, this, &ParameterRow::slide);
    connect(m_slider, &QSlider::sliderReleased, this, [this] { Q_EMIT edited(value(), false); });
    connect(m_spin, &QDoubleSpinBox::valueChanged, this, [this](double value) {
        const QSignalBlocker quiet(m_slider);
        m_slider->setValue(place_of(value));
        Q_EMIT edited(value, false);
    });
    setFocusProxy(m_spin);
}

void ParameterRow::name(const QString& name, const QString& tool_tip) {
    m_spin->setAccessibleName(name);
    m_slider->setAccessibleName(name);
    for (QWidget* one :
         {static_cast<QWidget*>(this), static_cast<QWidget*>(m_spin), static_cast<QWidget*>(m_slider)})
        one->setToolTip(tool_tip);
}

double ParameterRow::value() const {
    return m_spin->value() == m_rounded ? m_given : m_spin->value();
}

void ParameterRow::set_value(double value) {
    const QSignalBlocker quiet_spin(m_spin), quiet_slider(m_slider);
    m_spin->setRange(std::min(m_range.least, value), std::max(m_range.most, value));
    m_spin->setValue(value);
    m_given = value;
    m_rounded = m_spin->value();
    m_slider->setValue(place_of(value));
}

int ParameterRow::place_of(double value) const {
    const double share = m_range.is_ratio
                             ? std::log(value / m_range.least) / std::log(m_range.most / m_range.least)
                             : (value - m_range.least) / (m_range.most - m_range.least);
    return static_cast<int>(std::lround(std::clamp(share, 0.0, 1.0) * places));
}

double ParameterRow::value_at(int place) const {
    const double share = static_cast<double>(place) / places;
    return m_range.is_ratio ? m_range.least * std::pow(m_range.most / m_range.least, share)
                            : m_range.least + share * (m_range.most - m_range.least);
}

void ParameterRow::slide(int place) {
    const QSignalBlocker quiet(m_spin);
    m_spin->setValue(value_at(place));
    Q_EMIT edited(value(), m_slider->isSliderDown());
}

}  // namespace weave::studio
