#include <studio/panels/simulation_findings.hpp>

#include <QEvent>
#include <QHeaderView>
#include <QStyledItemDelegate>

#include <algorithm>
#include <studio/panels/plain_tip.hpp>

namespace weave::studio {

namespace {

constexpr int pick_role = Qt::UserRole, end_role = Qt::UserRole + 1;

/// Lines as tall as their words need in the width that there is; Qt's own measures them as if they had all
/// the width they want.
class WrappingLines : public QStyledItemDelegate {
  public:
    explicit WrappingLines(QTreeView* view) : QStyledItemDelegate(view), m_view(view) {}
    [[nodiscard]] QSize sizeHint(const QStyleOptionViewItem& option,
                                 const QModelIndex& index) const override {
        const int levels = index.parent().isValid() ? 2 : 1, margin = 8;
        const int width =
            std::max(margin, m_view->viewport()->width() - levels * m_view->indentation() - margin);
        const QFontMetrics font(index.data(Qt::FontRole).isValid() ? index.data(Qt::FontRole).value<QFont>()
                                                                   : option.font);
        const QRect box =
            font.boundingRect(QRect(0, 0, width, 1 << 20), Qt::TextWordWrap, index.data().toString());
        return {width, box.height() + font.height() / 4};
    }

  private:
    QTreeView* m_view;
};

QTreeWidgetItem* line_below(QTreeWidgetItem* above, const QString& words) {
    auto* item = new QTreeWidgetItem(above, {words});
    item->setToolTip(0, plain_tip(words));
    return item;
}

}  // namespace

SimulationFindings::SimulationFindings(QWidget* parent) : QTreeWidget(parent) {
    setHeaderHidden(true);
    setWordWrap(true);
    setTextElideMode(Qt::ElideNone);
    setItemDelegate(new WrappingLines(this));
    setColumnCount(1);
    header()->setSectionResizeMode(QHeaderView::Stretch);
    setIndentation(fontMetrics().height());
    setAccessibleName(tr("Findings"));
    m_inspection = new QTreeWidgetItem(this, {tr("The cloth at rest")});
    m_plan = new QTreeWidgetItem(this, {tr("What is modelled and why")});
    for (QTreeWidgetItem* item : {m_inspection, m_plan}) {
        QFont bold = font();
        bold.setBold(true);
        item->setFont(0, bold);
    }
    m_inspection->setExpanded(true);
    set_inspection({}, false);
    set_plan({});
    connect(this, &QTreeWidget::itemClicked, this, [this](QTreeWidgetItem* item) { lead_to(item); });
    connect(this, &QTreeWidget::itemActivated, this, [this](QTreeWidgetItem* item) { lead_to(item); });
}

void SimulationFindings::set_inspection(const std::vector<StateLine>& lines, bool is_known) {
    qDeleteAll(m_inspection->takeChildren());
    if (!is_known) line_below(m_inspection, tr("Shown once it rests"))->setDisabled(true);
    for (const StateLine& line : lines) {
        QTreeWidgetItem* item = line_below(m_inspection, line.text);
        if (!line.place) continue;
        item->setData(0, pick_role, static_cast<qulonglong>(line.place->pick));
        item->setData(0, end_role, static_cast<qulonglong>(line.place->end));
        item->setToolTip(0, tr("Go to pick %1, end %2").arg(line.place->pick + 1).arg(line.place->end + 1));
    }
    colour_links();
}

void SimulationFindings::colour_links() {
    for (int k = 0; k < m_inspection->childCount(); ++k) {
        QTreeWidgetItem* item = m_inspection->child(k);
        if (item->data(0, pick_role).isValid()) item->setForeground(0, palette().color(QPalette::Link));
    }
}

void SimulationFindings::changeEvent(QEvent* event) {
    QTreeWidget::changeEvent(event);
    if (event->type() == QEvent::PaletteChange) colour_links();
}

void SimulationFindings::resizeEvent(QResizeEvent* event) {
    QTreeWidget::resizeEvent(event);
    scheduleDelayedItemsLayout();  // other widths, other heights
}

void SimulationFindings::set_plan(const std::vector<QString>& lines) {
    qDeleteAll(m_plan->takeChildren());
    if (lines.empty()) line_below(m_plan, tr("Shown once the yarns are laid out"))->setDisabled(true);
    for (const QString& line : lines) line_below(m_plan, line);
}

void SimulationFindings::lead_to(const QTreeWidgetItem* item) {
    const QVariant pick = item->data(0, pick_role), end = item->data(0, end_role);
    if (pick.isValid() && end.isValid()) Q_EMIT place_wanted(pick.toULongLong(), end.toULongLong());
}

}  // namespace weave::studio
