#include <studio/panels/yarn_table.hpp>

#include <QColorDialog>
#include <QHeaderView>
#include <QScopedValueRollback>
#include <QScrollBar>

#include <algorithm>
#include <array>

namespace weave::studio {

namespace {

constexpr int name_column = 0, colour_column = 1;
/// What a cell stands for: a colour, or a number with all its digits.
constexpr int exact_role = Qt::UserRole, shown_role = Qt::UserRole + 1;
/// The members behind the columns from the third on.
constexpr std::array members{"radius_mm", "linear_density_tex", "stretch_stiffness_N", "bending_stiffness_N_mm2", "contact_stiffness_N_mm2"};

}  // namespace

YarnTable::YarnTable(QWidget* parent) : QTableWidget(parent) {
    setColumnCount(2 + static_cast<int>(members.size()));
    setHorizontalHeaderLabels({tr("Name"), tr("Colour"), tr("Radius\nmm"), tr("Weight\ntex"), tr("Stretch\nN"), tr("Bend\nN mm²"), tr("Contact\nN/mm²")});
    horizontalHeader()->setMinimumSectionSize(2 * fontMetrics().height());
    const QStringList tips{tr("Name of the yarn"), tr("Its colour in all pictures"), tr("Half of its thickness"), tr("Grams of a kilometre of it"), tr("How it resists being stretched: the force that would double its length (EA)"),
                           tr("How it resists being bent (EI)"), tr("How it resists being pressed flat: force per length of yarn and depth")};
    for (int column = 0; column < tips.size(); ++column) horizontalHeaderItem(column)->setToolTip(tips[column]);
    horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
    horizontalHeader()->setSectionResizeMode(name_column, QHeaderView::Interactive);
    const auto follow = [this](int column) {
        if (column != name_column) fit_names();
    };
    connect(horizontalHeader(), &QHeaderView::sectionResized, this, follow, Qt::QueuedConnection);  // while the header resizes, its widths are half old
    verticalHeader()->setSectionResizeMode(QHeaderView::Fixed);
    setSelectionBehavior(QAbstractItemView::SelectRows);
    connect(this, &QTableWidget::itemChanged, this, [this] {
        if (!m_is_filling) Q_EMIT edited();
    });
    connect(this, &QTableWidget::cellActivated, this, [this](int row, int column) {
        if (column == colour_column) ask_colour(row);
    });
}

/// Names have the width that the numbers leave. Where they leave too little, the numbers are scrolled, and name and colour are in sight.
void YarnTable::fit_names() {
    const int line = fontMetrics().height(), left = viewport()->width() - (horizontalHeader()->length() - columnWidth(name_column));
    setColumnWidth(name_column, left >= 2 * line ? left : 7 * line);
}

void YarnTable::resizeEvent(QResizeEvent* event) {
    QTableWidget::resizeEvent(event);
    fit_names();
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
    QTableWidgetItem* patch = set(colour_column, {});
    patch->setFlags(Qt::ItemIsEnabled | Qt::ItemIsSelectable);
    show_colour(*patch, QString::fromStdString(yarn.value("colour", "#808080")));
    for (std::size_t k = 0; k < members.size(); ++k) {
        const double number = yarn.value(members[k], 0.0);
        QTableWidgetItem* cell = set(2 + static_cast<int>(k), QString::number(number, 'g', 4));
        cell->setData(exact_role, number);
        cell->setData(shown_role, cell->text());
    }
}

void YarnTable::show_colour(QTableWidgetItem& patch, const QString& colour) {
    patch.setData(exact_role, colour);
    patch.setData(Qt::AccessibleTextRole, colour);
    patch.setBackground(QColor(colour));
    patch.setToolTip(tr("%1. Double-click to choose another colour").arg(QColor(colour).name()));
}

/// A number that nobody typed anew keeps the digits that its cell has no room for. One that is none stays a text: the library says
/// what it misses.
Json YarnTable::number_in(const QTableWidgetItem& cell) {
    if (cell.text() == cell.data(shown_role).toString()) return cell.data(exact_role).toDouble();
    bool is_number = false;
    const double number = cell.text().toDouble(&is_number);
    return is_number ? Json(number) : Json(cell.text().toStdString());
}

Json YarnTable::yarns() const {
    Json yarns = Json::array();
    for (int row = 0; row < rowCount(); ++row) {
        Json yarn{{"name", item(row, name_column)->text().toStdString()}, {"colour", item(row, colour_column)->data(exact_role).toString().toStdString()}};
        for (std::size_t k = 0; k < members.size(); ++k) yarn[members[k]] = number_in(*item(row, 2 + static_cast<int>(k)));
        yarns.push_back(std::move(yarn));
    }
    return yarns;
}

void YarnTable::ask_colour(int row) {
    const QColor colour = QColorDialog::getColor(QColor(item(row, colour_column)->data(exact_role).toString()), this, tr("Colour of the yarn"));
    if (!colour.isValid()) return;
    {
        const QScopedValueRollback quiet(m_is_filling, true);
        show_colour(*item(row, colour_column), colour.name());
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
