#include <studio/window/message_bar.hpp>

#include <QHBoxLayout>
#include <QLabel>
#include <QToolButton>

namespace weave::studio {

MessageBar::MessageBar(QWidget* parent) : QFrame(parent), m_words(new QLabel) {
    setObjectName("message-bar");
    setAutoFillBackground(true);
    m_words->setWordWrap(true);
    m_words->setTextFormat(Qt::PlainText);
    m_words->setTextInteractionFlags(Qt::TextSelectableByMouse);
    auto* close = new QToolButton;
    close->setText("✕");
    close->setAutoRaise(true);
    close->setToolTip(tr("Close this message"));
    close->setAccessibleName(close->toolTip());
    connect(close, &QToolButton::clicked, this, &QWidget::hide);
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(12, 6, 6, 6);
    row->addWidget(m_words, 1);
    row->addWidget(close, 0, Qt::AlignTop);
    hide();
}

void MessageBar::say(const QString& words, Weight weight) {
    // Both grounds bear black text: 13:1 and more.
    QPalette colours = palette();
    colours.setColor(QPalette::Window, weight == Weight::failure ? QColor(0xff, 0xd9, 0xb8) : QColor(0xcf, 0xe8, 0xf7));
    colours.setColor(QPalette::WindowText, Qt::black);
    setPalette(colours);
    m_words->setText(words);
    show();
}

QString MessageBar::words() const {
    return isHidden() ? QString() : m_words->text();
}

}  // namespace weave::studio
