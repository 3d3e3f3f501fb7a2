#include <studio/panels/scaled_picture.hpp>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QStyle>
#include <QStyleOptionFocusRect>

#include <algorithm>

namespace weave::studio {

namespace {

constexpr int most_lines = 30;

}  // namespace

ScaledPicture::ScaledPicture(QWidget* parent) : QWidget(parent) {
    QSizePolicy policy(QSizePolicy::Expanding, QSizePolicy::Preferred);
    policy.setHeightForWidth(true);
    setSizePolicy(policy);
    setFocusPolicy(Qt::TabFocus);
    setCursor(Qt::PointingHandCursor);
    setToolTip(tr("Show it large"));
    setAccessibleName(tr("Both cards laid on each other; Enter shows them large"));
}

void ScaledPicture::set_image(const QImage& image) {
    m_image = image;
    setVisible(!image.isNull());
    updateGeometry();
    update();
}

QSize ScaledPicture::shown_in(int width) const {
    if (m_image.isNull()) return {0, 0};
    const QSize room(std::max(1, width), most_lines * fontMetrics().height());
    const QSize whole = m_image.deviceIndependentSize().toSize();
    return whole.width() <= room.width() && whole.height() <= room.height() ? whole : whole.scaled(room, Qt::KeepAspectRatio);
}

QSize ScaledPicture::sizeHint() const {
    return shown_in(20 * fontMetrics().height());
}

int ScaledPicture::heightForWidth(int width) const {
    return shown_in(width).height();
}

void ScaledPicture::paintEvent(QPaintEvent*) {
    if (m_image.isNull()) return;
    QPainter painter(this);
    const QSize shown = shown_in(width());
    const qreal ratio = devicePixelRatioF();
    const QImage small = m_image.scaled(shown * ratio, Qt::KeepAspectRatio, Qt::SmoothTransformation);
    painter.drawImage(QRectF(QPointF(0, 0), QSizeF(shown)), small);
    if (!hasFocus()) return;
    QStyleOptionFocusRect option;
    option.initFrom(this);
    option.rect = QRect(QPoint(0, 0), shown);
    style()->drawPrimitive(QStyle::PE_FrameFocusRect, &option, &painter, this);
}

void ScaledPicture::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() == Qt::LeftButton && rect().contains(event->position().toPoint()))
        Q_EMIT large_wanted();
}

/// Space is its own while it has the focus, and no command of the window.
bool ScaledPicture::event(QEvent* event) {
    if (event->type() != QEvent::ShortcutOverride || static_cast<QKeyEvent*>(event)->key() != Qt::Key_Space) return QWidget::event(event);
    event->accept();
    return true;
}

void ScaledPicture::keyPressEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter || event->key() == Qt::Key_Space)
        return Q_EMIT large_wanted();
    QWidget::keyPressEvent(event);
}

}  // namespace weave::studio
