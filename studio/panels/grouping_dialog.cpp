#include <studio/panels/grouping_dialog.hpp>

#include <QDialogButtonBox>
#include <QLabel>
#include <QListWidget>
#include <QVBoxLayout>

#include <algorithm>

namespace weave::studio {

namespace {

/// The counts of rows or columns: one number where all are the same.
QString counts_words(const std::vector<std::uint32_t>& counts) {
    constexpr std::size_t most_told = 12;
    if (std::ranges::adjacent_find(counts, std::ranges::not_equal_to()) == counts.end()) return QString::number(counts.front());
    QStringList words;
    for (std::size_t k = 0; k < std::min(counts.size(), most_told); ++k) words.push_back(QString::number(counts[k]));
    if (counts.size() > most_told) words.push_back(QStringLiteral("…"));
    return words.join(QStringLiteral(", "));
}

}  // namespace

QString grouping_words(const Grouping& grouping) {
    return GroupingDialog::tr("%1 picks a row, %2 ends a column").arg(counts_words(grouping.t), counts_words(grouping.p));
}

GroupingDialog::GroupingDialog(const std::vector<Grouping>& groupings, QWidget* parent) : QDialog(parent), m_list(new QListWidget) {
    setWindowTitle(tr("Layers of the card"));
    auto* about = new QLabel(tr("A card does not say which of its picks and ends lie on top of one another. These readings fit it, the likeliest first:"));
    about->setWordWrap(true);
    m_list->setObjectName("groupings");
    m_list->setWordWrap(true);
    for (const Grouping& one : groupings) m_list->addItem(grouping_words(one) + "\n" + QString::fromStdString(one.reason));
    m_list->setCurrentRow(0);
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel);
    auto* column = new QVBoxLayout(this);
    column->addWidget(about);
    column->addWidget(m_list, 1);
    column->addWidget(buttons);
    const int em = fontMetrics().height();
    resize(34 * em, 22 * em);
    connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    connect(m_list, &QListWidget::itemActivated, this, &QDialog::accept);
}

std::size_t GroupingDialog::chosen() const {
    return static_cast<std::size_t>(std::max(0, m_list->currentRow()));
}

}  // namespace weave::studio
