#include <studio/panels/message_bar.hpp>

#include <QAction>
#include <QHBoxLayout>
#include <QLabel>
#include <QStyle>
#include <QToolButton>

namespace weave::studio {

MessageBar::MessageBar(QWidget* parent)
    : QFrame(parent), m_icon(new QLabel(this)), m_words(new QLabel(this)), m_offer(new QToolButton(this)), m_close(new QToolButton(this)) {
    setFrameShape(QFrame::StyledPanel);
    setAutoFillBackground(true);
    auto* line = new QHBoxLayout(this);
    line->addWidget(m_icon, 0, Qt::AlignTop);
    line->addWidget(m_words, 1);
    line->addWidget(m_offer, 0, Qt::AlignTop);
    line->addWidget(m_close, 0, Qt::AlignTop);
    m_words->setWordWrap(true);
    m_words->setTextFormat(Qt::PlainText);
    m_words->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
    m_close->setIcon(style()->standardIcon(QStyle::SP_TitleBarCloseButton));
    m_close->setAutoRaise(true);
    m_close->setObjectName("close-message");
    m_close->setToolTip(tr("Close this message"));
    m_close->setAccessibleName(m_close->toolTip());
    m_offer->setObjectName("offer");
    m_offer->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    connect(m_close, &QToolButton::clicked, this, &MessageBar::clear);
    hide();
}

void MessageBar::tell(Kind kind, const QString& words, QAction* offer) {
    m_kind = kind;
    show_offer(offer);
    // All three grounds bear black text: 12:1 and more.
    QPalette colours = palette();
    colours.setColor(QPalette::Window, kind == Kind::error ? QColor(0xff, 0xd9, 0xb8) : kind == Kind::warning ? QColor(0xff, 0xf0, 0xc2) : QColor(0xd4, 0xea, 0xf7));
    colours.setColor(QPalette::WindowText, Qt::black);
    setPalette(colours);
    m_words->setText(words);
    m_words->setAccessibleName(words);
    const auto icon = kind == Kind::error     ? QStyle::SP_MessageBoxCritical
                      : kind == Kind::warning ? QStyle::SP_MessageBoxWarning
                                              : QStyle::SP_MessageBoxInformation;
    const int size = style()->pixelMetric(QStyle::PM_SmallIconSize, nullptr, this);
    m_icon->setPixmap(style()->standardIcon(icon).pixmap(QSize(size, size), devicePixelRatioF()));
    show();
}

void MessageBar::show_offer(QAction* offer) {
    if (QAction* before = m_offer->defaultAction()) {
        before->disconnect(this);
        m_offer->removeAction(before);
    }
    m_offer->setDefaultAction(offer);
    m_offer->setVisible(offer != nullptr);
    if (offer != nullptr) connect(offer, &QAction::triggered, this, &MessageBar::clear);
}

void MessageBar::clear() {
    show_offer(nullptr);
    m_words->clear();
    hide();
}

QString MessageBar::words() const {
    return m_words->text();
}

}  // namespace weave::studio
