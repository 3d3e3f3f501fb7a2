#include <studio/editors/bubble.hpp>

#include <QEvent>

#include <algorithm>

namespace weave::studio {

Bubble::Bubble(QWidget* parent) : QLabel(parent) {
    setObjectName("bubble");
    setWordWrap(true);
    setTextFormat(Qt::PlainText);
    setMargin(fontMetrics().averageCharWidth());
    setAttribute(Qt::WA_TransparentForMouseEvents);
    setStyleSheet("background: #2b2b2b; color: white; border-radius: 4px;");
    hide();
    m_goes.setSingleShot(true);
    connect(&m_goes, &QTimer::timeout, this, &QWidget::hide);
    parent->installEventFilter(this);
}

void Bubble::say(const QString& words, QPoint place) {
    setText(words);
    const int widest = std::min(parentWidget()->width() - 8, fontMetrics().averageCharWidth() * 48);
    const int wish = fontMetrics().horizontalAdvance(words) + 4 * margin();
    resize(std::max(1, std::min(wish, widest)), 1);
    resize(width(), std::max(heightForWidth(width()), fontMetrics().height() + 2 * margin()));
    const int below = place.y() + fontMetrics().height();
    const int y = below + height() <= parentWidget()->height()
                      ? below
                      : place.y() - height() - fontMetrics().height() / 2;
    const int x = std::clamp(place.x() - width() / 2, 4, std::max(4, parentWidget()->width() - width() - 4));
    move(x, std::max(4, y));
    show();
    raise();
    m_goes.start(2500 + 60 * static_cast<int>(words.size()));
}

bool Bubble::eventFilter(QObject* watched, QEvent* event) {
    switch (event->type()) {
        case QEvent::MouseButtonPress:
        case QEvent::KeyPress:
        case QEvent::Wheel:
        case QEvent::Hide:
            hide();
            break;
        default:
            break;
    }
    return QLabel::eventFilter(watched, event);
}

}  // namespace weave::studio
