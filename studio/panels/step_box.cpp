#include <studio/panels/step_box.hpp>

#include <QHBoxLayout>
#include <QLabel>
#include <QPainter>
#include <QPixmap>
#include <QStyle>
#include <QVBoxLayout>
#include <studio/panels/plain_tip.hpp>

namespace weave::studio {

namespace {

constexpr QColor disc(0x00, 0x72, 0xb2);

QPixmap number_disc(int number, const QFont& font, int side, qreal ratio) {
    QPixmap pixmap(QSize(side, side) * ratio);
    pixmap.setDevicePixelRatio(ratio);
    pixmap.fill(Qt::transparent);
    QPainter painter(&pixmap);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setBrush(disc);
    painter.setPen(Qt::NoPen);
    painter.drawEllipse(QRectF(0, 0, side, side));
    painter.setPen(Qt::white);
    painter.setFont(font);
    painter.drawText(QRectF(0, 0, side, side), Qt::AlignCenter, QString::number(number));
    return pixmap;
}

}  // namespace

StepBox::StepBox(int number, const QString& title, QWidget* parent)
    : QFrame(parent), m_words(new QLabel), m_body(new QVBoxLayout) {
    QFont bold = font();
    bold.setBold(true);
    const int side = fontMetrics().height() * 3 / 2;
    auto* badge = new QLabel;
    badge->setPixmap(number_disc(number, bold, side, devicePixelRatioF()));
    auto* heading = new QLabel(title);
    heading->setFont(bold);
    m_words->setTextFormat(Qt::PlainText);
    m_words->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
    m_words->setForegroundRole(QPalette::PlaceholderText);
    m_words->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
    auto* top = new QHBoxLayout;
    top->addWidget(badge);
    top->addWidget(heading);
    top->addWidget(m_words, 1);
    m_body->setContentsMargins(side + style()->pixelMetric(QStyle::PM_LayoutHorizontalSpacing), 0, 0, 0);
    auto* all = new QVBoxLayout(this);
    all->setContentsMargins(0, 0, 0, side / 2);
    all->addLayout(top);
    all->addLayout(m_body);
    setAccessibleName(title);
}

void StepBox::say(const QString& words) {
    m_words->setText(words);
    m_words->setToolTip(plain_tip(words));
}

}  // namespace weave::studio
