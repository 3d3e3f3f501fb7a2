#include <studio/editors/stencil_palette.hpp>

#include <studio/editors/plain_text.hpp>

#include <QHBoxLayout>
#include <QLabel>
#include <QPainter>
#include <QShortcut>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include <algorithm>

namespace weave::studio {

namespace {

/// The colour that stands for a block in the picture, and the block's own look beside it.
QIcon icon_of(const PaletteEntry& entry, int high, double ratio) {
    const int wide = entry.thumbnail.isNull() ? high : 2 * high + 3;
    QPixmap pixmap(QSize(wide, high) * ratio);
    pixmap.setDevicePixelRatio(ratio);
    pixmap.fill(Qt::transparent);
    QPainter painter(&pixmap);
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    painter.setPen(QColor(0x59, 0x59, 0x59));
    painter.setBrush(entry.colour);
    painter.drawRect(0, 0, high - 1, high - 1);
    if (!entry.thumbnail.isNull()) {
        painter.setOpacity(entry.reason.isEmpty() ? 1 : 0.35);
        painter.drawPixmap(QRect(high + 3, 0, high, high), entry.thumbnail);
    }
    QIcon icon(pixmap);
    icon.addPixmap(pixmap, QIcon::Selected);  // the colour is information: it stays as it is
    return icon;
}

}  // namespace

StencilPalette::StencilPalette(QWidget* parent)
    : QWidget(parent), m_list(new QListWidget(this)), m_menu(new QMenu(this)) {
    m_list->setObjectName("palette");
    m_list->setAccessibleName(tr("Blocks of the stencil"));
    m_list->setWordWrap(true);
    const int high = fontMetrics().height() * 2;
    m_list->setIconSize({2 * high + 3, high});
    m_list->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    m_add = button("add_block", tr("Add"), tr("Add a block of the design to the palette"));
    m_remove = button("remove_block", tr("Remove"), tr("Take the block out of the palette (Del)"));
    m_up = button("block_up", tr("↑"), tr("Move the block up (Ctrl+Up)"));
    m_down = button("block_down", tr("↓"), tr("Move the block down (Ctrl+Down)"));
    m_add->setMenu(m_menu);
    m_add->setPopupMode(QToolButton::InstantPopup);
    auto* row = new QHBoxLayout;
    for (QToolButton* one : {m_add, m_remove, m_up, m_down}) row->addWidget(one);
    row->addStretch(1);
    auto* rows = new QVBoxLayout(this);
    rows->setContentsMargins(0, 0, 0, 0);
    auto* title = new QLabel(tr("Blocks"), this);
    title->setBuddy(m_list);
    rows->addWidget(title);
    rows->addWidget(m_list, 1);
    rows->addLayout(row);
    setMinimumWidth(fontMetrics().averageCharWidth() * 34);
    connect(m_list, &QListWidget::currentRowChanged, this, &StencilPalette::chosen_changed);
    connect(m_remove, &QToolButton::clicked, this, [this] { Q_EMIT remove_wanted(chosen()); });
    connect(m_up, &QToolButton::clicked, this, [this] { Q_EMIT move_wanted(chosen(), -1); });
    connect(m_down, &QToolButton::clicked, this, [this] { Q_EMIT move_wanted(chosen(), 1); });
    const auto key = [&](const QKeySequence& keys, QToolButton* one) {
        connect(new QShortcut(keys, m_list, nullptr, nullptr, Qt::WidgetShortcut), &QShortcut::activated, one,
                &QToolButton::click);
    };
    key(QKeySequence::Delete, m_remove);
    key(Qt::CTRL | Qt::Key_Up, m_up);
    key(Qt::CTRL | Qt::Key_Down, m_down);
}

QToolButton* StencilPalette::button(const QString& name, const QString& text, const QString& tip) {
    auto* one = new QToolButton(this);
    one->setObjectName(name);
    one->setText(text);
    one->setToolTip(tip);
    one->setAccessibleName(tip);
    return one;
}

QColor StencilPalette::colour_of(std::size_t entry) {
    static const QColor colours[] = {
        QColor(0xf0, 0xe4, 0x42), QColor(0x00, 0x72, 0xb2), QColor(0xe6, 0x9f, 0x00),
        QColor(0x56, 0xb4, 0xe9), QColor(0xd5, 0x5e, 0x00), QColor(0x00, 0x9e, 0x73),
        QColor(0xcc, 0x79, 0xa7), QColor(0x33, 0x22, 0x88), QColor(0xdd, 0xcc, 0x77),
        QColor(0x88, 0x22, 0x55), QColor(0x99, 0x99, 0x33), QColor(0x44, 0xaa, 0x99)};
    constexpr std::size_t count = std::size(colours);
    const QColor colour = colours[entry % count];
    const std::size_t round = entry / count % 4;
    if (round == 0) return colour;
    return round % 2 == 1 ? colour.darker(100 + 45 * static_cast<int>(round)) : colour.lighter(130);
}

void StencilPalette::show_entries(const std::vector<PaletteEntry>& entries) {
    const QSignalBlocker quiet(m_list);
    const int was = std::max(0, m_list->currentRow());
    m_list->clear();
    for (const PaletteEntry& entry : entries) {
        QString words = entry.name;
        if (entry.stacks)
            words += "\n" + (*entry.stacks == 1 ? tr("1 stack") : tr("%L1 stacks").arg(*entry.stacks));
        if (!entry.reason.isEmpty()) words = entry.name + "\n" + entry.reason;
        auto* item = new QListWidgetItem(icon_of(entry, fontMetrics().height() * 2, devicePixelRatioF()),
                                         words, m_list);
        item->setToolTip(as_plain(entry.reason.isEmpty() ? entry.name : entry.reason));
        if (!entry.reason.isEmpty()) item->setForeground(palette().color(QPalette::Disabled, QPalette::Text));
    }
    m_list->setCurrentRow(std::min(was, m_list->count() - 1));
    m_remove->setEnabled(!entries.empty());
    m_up->setEnabled(entries.size() > 1);
    m_down->setEnabled(entries.size() > 1);
}

void StencilPalette::show_choices(const std::vector<BlockChoice>& choices) {
    m_menu->clear();
    m_menu->setToolTipsVisible(true);
    for (const BlockChoice& choice : choices) {
        const QString words =
            choice.reason.isEmpty() ? choice.name : tr("%1 — %2").arg(choice.name, choice.reason);
        QAction* action = m_menu->addAction(choice.thumbnail, words, this,
                                            [this, name = choice.name] { Q_EMIT add_wanted(name); });
        action->setEnabled(choice.reason.isEmpty());
        action->setObjectName(choice.name);
        action->setToolTip(as_plain(words));
    }
    if (choices.empty()) m_menu->addAction(tr("The design has no block to add"))->setEnabled(false);
}

}  // namespace weave::studio
