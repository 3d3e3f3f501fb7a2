#include <studio/panels/simulation_region_group.hpp>

#include <QGridLayout>
#include <QLabel>
#include <QRadioButton>
#include <QSignalBlocker>
#include <QSpinBox>

#include <algorithm>
#include <limits>
#include <numeric>

namespace weave::studio {

namespace {

/// Fewer have nothing that can move, as the rims are held.
constexpr int fewest = 3;
constexpr int usual_part = 20;

int limited(std::size_t count) {
    return static_cast<int>(std::min<std::size_t>(count, std::numeric_limits<int>::max()));
}

void put(QSpinBox* box, int value) {
    const QSignalBlocker quiet(box);
    box->setValue(value);
}

}  // namespace

RegionGroup::RegionGroup(QWidget* parent)
    : QGroupBox(tr("What is simulated"), parent),
      m_yarns(new QLabel(this)),
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
    add(2, tr("Rows of picks"), m_first_row, m_last_row);
    add(3, tr("Columns of ends"), m_first_column, m_last_column);
    grid->addWidget(m_yarns, 4, 0, 1, 5);
    grid->setColumnStretch(4, 1);
    m_whole->setChecked(true);
    connect(m_part, &QRadioButton::toggled, this, [this] {
        tell_yarns();
        Q_EMIT edited();
    });
    set_cloth(BlockGrid({1}, {1}));
}

/// A part that nobody has chosen follows the cloth.
void RegionGroup::set_cloth(const BlockGrid& cloth) {
    if (m_grid == cloth) return;
    m_grid = cloth;
    const std::size_t rows = cloth.rows(), columns = cloth.columns();
    const QSignalBlocker quiet(this);
    const auto limit = [](QSpinBox* first, QSpinBox* last, int count) {
        const QSignalBlocker quiet_first(first), quiet_last(last);
        first->setRange(1, std::max(1, count - fewest + 1));
        last->setRange(std::min(fewest, count), count);
    };
    limit(m_first_row, m_last_row, limited(rows));
    limit(m_first_column, m_last_column, limited(columns));
    if (m_whole->isChecked()) {
        for (QSpinBox* first : {m_first_row, m_first_column}) put(first, 1);
        for (QSpinBox* last : {m_last_row, m_last_column}) put(last, usual_part);
    }
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
    tell_yarns();
}

void RegionGroup::tell_yarns() {
    const auto after = [](const std::vector<std::uint32_t>& counts, int lines) {
        const auto most = std::min<std::size_t>(counts.size(), static_cast<std::size_t>(lines));
        return std::accumulate(counts.begin(), counts.begin() + static_cast<std::ptrdiff_t>(most), std::size_t{0});
    };
    if (!m_part->isChecked())
        return m_yarns->setText(tr("all of it: picks 1 to %1, ends 1 to %2").arg(m_grid.picks()).arg(m_grid.ends()));
    m_yarns->setText(tr("picks %1 to %2, ends %3 to %4")
                         .arg(after(m_grid.t(), m_first_row->value() - 1) + 1)
                         .arg(after(m_grid.t(), m_last_row->value()))
                         .arg(after(m_grid.p(), m_first_column->value() - 1) + 1)
                         .arg(after(m_grid.p(), m_last_column->value())));
}

std::optional<Region> RegionGroup::region() const {
    if (!m_part->isChecked()) return {};
    const auto at = [](const QSpinBox* box) { return static_cast<std::size_t>(box->value() - 1); };
    return Region{at(m_first_row), at(m_last_row), at(m_first_column), at(m_last_column)};
}

}  // namespace weave::studio
