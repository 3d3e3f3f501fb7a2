#include <studio/panels/yarn_table.hpp>

#include <QColorDialog>
#include <QHeaderView>
#include <QScrollBar>
#include <QScopedValueRollback>

#include <algorithm>
#include <array>

namespace weave::studio {

namespace {

constexpr int name_column = 0, colour_column = 1;
/// The members behind the columns from the third on.
constexpr std::array members{"radius_mm", "linear_density_tex", "stretch_stiffness_N", "bending_stiffness_N_mm2", "contact_stiffness_N_mm2"};

}  // namespace

YarnTable::YarnTable(QWidget* parent) : QTableWidget(parent) {
    setColumnCount(2 + static_cast<int>(members.size()));
    setHorizontalHeaderLabels({tr("Name"), tr("Colour"), tr("Radius\nmm"), tr("Weight\ntex"), tr("Stretch EA\nN"), tr("Bending EI\nN mm²"), tr("Contact k\nN/mm²")});
    horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
    horizontalHeader()->setStretchLastSection(true);
    setSelectionBehavior(QAbstractItemView::SelectRows);
    connect(this, &QTableWidget::itemChanged, this, [this] {
        if (!m_is_filling) Q_EMIT edited();
    });
    connect(this, &QTableWidget::cellActivated, this, [this](int row, int column) {
        if (column == colour_column) ask_colour(row);
    });
    connect(this, &QTableWidget::cellDoubleClicked, this, [this](int row, int column) {
        if (column == colour_column) ask_colour(row);
    });
}

void YarnTable::show_yarns(const Json& yarns) {
    const QScopedValueRollback quiet(m_is_filling, true);
    setRowCount(static_cast<int>(yarns.size()));
    for (int row = 0; row < rowCount(); ++row) fill_row(row, yarns[static_cast<std::size_t>(row)]);
    const int line = verticalHeader()->defaultSectionSize();
    setFixedHeight(horizontalHeader()->sizeHint().height() + line * std::clamp(rowCount(), 1, 4) + horizontalScrollBar()->sizeHint().height() + 6);
}

void YarnTable::fill_row(int row, const Json& yarn) {
    const auto set = [&](int column, const QString& text) {
        auto* cell = new QTableWidgetItem(text);
        setItem(row, column, cell);
        return cell;
    };
    set(name_column, QString::fromStdString(yarn.value("name", "")));
    const QString colour = QString::fromStdString(yarn.value("colour", "#808080"));
    QTableWidgetItem* patch = set(colour_column, colour);
    patch->setBackground(QColor(colour));
    patch->setForeground(QColor(colour).lightnessF() > 0.55 ? Qt::black : Qt::white);
    patch->setFlags(Qt::ItemIsEnabled | Qt::ItemIsSelectable);
    patch->setToolTip(tr("Double-click to choose a colour"));
    for (std::size_t k = 0; k < members.size(); ++k) set(2 + static_cast<int>(k), QString::number(yarn.value(members[k], 0.0), 'g', 10));
}

Json YarnTable::yarns() const {
    Json yarns = Json::array();
    for (int row = 0; row < rowCount(); ++row) {
        Json yarn{{"name", item(row, name_column)->text().toStdString()}, {"colour", item(row, colour_column)->text().toStdString()}};
        for (std::size_t k = 0; k < members.size(); ++k) {
            const QString text = item(row, 2 + static_cast<int>(k))->text();
            bool is_number = false;
            const double number = text.toDouble(&is_number);
            yarn[members[k]] = is_number ? Json(number) : Json(text.toStdString());  // the library says what it misses
        }
        yarns.push_back(std::move(yarn));
    }
    return yarns;
}

void YarnTable::ask_colour(int row) {
    const QColor colour = QColorDialog::getColor(QColor(item(row, colour_column)->text()), this, tr("Colour of the yarn"));
    if (!colour.isValid()) return;
    {
        const QScopedValueRollback quiet(m_is_filling, true);
        item(row, colour_column)->setText(colour.name());
        item(row, colour_column)->setBackground(colour);
    }
    Q_EMIT edited();
}

void YarnTable::add_yarn() {
    Json all = yarns();
    if (all.empty()) return;
    Json added = all.back();
    added["name"] = tr("yarn %1").arg(all.size() + 1).toStdString();
    all.push_back(std::move(added));
    show_yarns(all);
    Q_EMIT edited();
}

void YarnTable::remove_chosen() {
    const int row = currentRow();
    if (row < 0 || rowCount() == 1) return;
    {
        const QScopedValueRollback quiet(m_is_filling, true);
        removeRow(row);
    }
    Q_EMIT edited();
}

}  // namespace weave::studio
