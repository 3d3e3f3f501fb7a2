#include <studio/panels/simulation_region_group.hpp>

#include <QGridLayout>
#include <QLabel>
#include <QRadioButton>
#include <QSignalBlocker>
#include <QSpinBox>

#include <algorithm>
#include <limits>

namespace weave::studio {

namespace {

/// Fewer have nothing that can move, as the rims are held.
constexpr int fewest = 3;
constexpr int usual_part = 20;

int limited(std::size_t count) {
    return static_cast<int>(std::min<std::size_t>(count, std::numeric_limits<int>::max()));
}

}  // namespace

RegionGroup::RegionGroup(QWidget* parent)
    : QGroupBox(tr("What is simulated"), parent),
      m_whole(new QRadioButton(tr("The &whole cloth"), this)),
      m_part(new QRadioButton(tr("A &part of it"), this)),
      m_first_row(new QSpinBox(this)),
      m_last_row(new QSpinBox(this)),
      m_first_column(new QSpinBox(this)),
      m_last_column(new QSpinBox(this)) {
    m_part->setToolTip(
        tr("A part of a huge cloth, at least three rows and columns of stacks. Its rims are held as planned, "
           "so what lies within two rows and columns of them is disturbed."));
    auto* grid = new QGridLayout(this);
    grid->addWidget(m_whole, 0, 0, 1, 5);
    grid->addWidget(m_part, 1, 0, 1, 5);
    const auto add = [&](int line, const QString& name, QSpinBox* first, QSpinBox* last) {
        grid->addWidget(new QLabel(name, this), line, 0);
        grid->addWidget(first, line, 1);
        grid->addWidget(new QLabel(tr("to"), this), line, 2);
        grid->addWidget(last, line, 3);
        first->setAccessibleName(tr("%1 from").arg(name));
        last->setAccessibleName(tr("%1 to").arg(name));
        for (QSpinBox* box : {first, last}) {
            box->setKeyboardTracking(false);
            connect(box, &QSpinBox::valueChanged, this, [this] {
                keep_in_order();
                Q_EMIT edited();
            });
            connect(m_part, &QRadioButton::toggled, box, &QWidget::setEnabled);
            box->setEnabled(false);
        }
    };
    add(2, tr("Rows"), m_first_row, m_last_row);
    add(3, tr("Columns"), m_first_column, m_last_column);
    grid->setColumnStretch(4, 1);
    m_whole->setChecked(true);
    connect(m_part, &QRadioButton::toggled, this, [this] { Q_EMIT edited(); });
    set_cloth_size(std::size_t{1} << 28U, std::size_t{1} << 28U);
    for (QSpinBox* last : {m_last_row, m_last_column}) last->setValue(usual_part);
}

void RegionGroup::set_cloth_size(std::size_t rows, std::size_t columns) {
    const QSignalBlocker quiet(this);
    const auto limit = [](QSpinBox* first, QSpinBox* last, int count) {
        const QSignalBlocker quiet_first(first), quiet_last(last);
        first->setRange(1, std::max(1, count - fewest + 1));
        last->setRange(std::min(fewest, count), count);
    };
    limit(m_first_row, m_last_row, limited(rows));
    limit(m_first_column, m_last_column, limited(columns));
    const bool is_cuttable = rows >= fewest && columns >= fewest;
    m_part->setEnabled(is_cuttable);
    if (!is_cuttable) m_whole->setChecked(true);
    keep_in_order();
}

void RegionGroup::keep_in_order() {
    const auto keep = [](QSpinBox* first, QSpinBox* last) {
        const QSignalBlocker quiet(last);
        if (last->value() < first->value() + fewest - 1) last->setValue(first->value() + fewest - 1);
    };
    keep(m_first_row, m_last_row);
    keep(m_first_column, m_last_column);
}

std::optional<Region> RegionGroup::region() const {
    if (!m_part->isChecked()) return {};
    const auto at = [](const QSpinBox* box) { return static_cast<std::size_t>(box->value() - 1); };
    return Region{at(m_first_row), at(m_last_row), at(m_first_column), at(m_last_column)};
}

}  // namespace weave::studio
