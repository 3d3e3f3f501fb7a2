#include <studio/panels/approval_flow.hpp>

#include <studio/panels/plain_tip.hpp>

#include <QCoreApplication>
#include <QPainter>

namespace weave::studio {

namespace {

constexpr QColor green(0x00, 0x9e, 0x73), blue(0x00, 0x72, 0xb2), vermilion(0xd5, 0x5e, 0x00);

/// How many stations are behind a revision of this state.
int reached(const QString& state) {
    if (state == "draft") return 1;
    if (state == "submitted" || state == "changes_requested") return 2;
    if (state == "approved") return 3;
    return state.isEmpty() ? 0 : 4;
}

}  // namespace

QString state_in_words(const QString& state) {
    if (state == "draft") return ApprovalFlow::tr("saved, not submitted");
    if (state == "submitted") return ApprovalFlow::tr("submitted, waits for approval");
    if (state == "changes_requested") return ApprovalFlow::tr("rejected: changes are asked for");
    if (state == "approved") return ApprovalFlow::tr("approved");
    if (state == "released") return ApprovalFlow::tr("released to a loom");
    if (state == "superseded") return ApprovalFlow::tr("superseded by a later release");
    if (state == "withdrawn") return ApprovalFlow::tr("withdrawn from the looms");
    return state.isEmpty() ? ApprovalFlow::tr("not saved yet") : state;
}

ApprovalFlow::ApprovalFlow(QWidget* parent) : QWidget(parent) {
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    show_state({});
}

void ApprovalFlow::show_state(const QString& state) {
    m_state = state;
    setAccessibleName(tr("State of the revision: %1").arg(words()));
    setToolTip(plain_tip(words()));
    update();
}

QString ApprovalFlow::words() const {
    return state_in_words(m_state);
}

QSize ApprovalFlow::sizeHint() const {
    const int line = fontMetrics().height();
    return {line * 24, line * 4};
}

QSize ApprovalFlow::minimumSizeHint() const {
    const int line = fontMetrics().height();
    return {line * 15, line * 4};
}

QList<ApprovalFlow::Station> ApprovalFlow::stations() const {
    const bool refused = m_state == "changes_requested",
               gone = m_state == "withdrawn" || m_state == "superseded";
    QList<Station> list{
        {tr("Saved")}, {tr("Submitted")}, {refused ? tr("Rejected") : tr("Approved")}, {tr("Released")}};
    if (gone) list[3].title = m_state == "withdrawn" ? tr("Withdrawn") : tr("Superseded");
    const int done = reached(m_state);
    for (int k = 0; k < list.size(); ++k)
        list[k].mark = k < done ? Mark::done : k == done ? Mark::waits : Mark::later;
    const QStringList next{tr("To save"), tr("To submit"), tr("To approve"), tr("To release")};
    if (done < list.size() && !refused) list[done].title = next[done];
    if (refused) list[2].mark = Mark::refused;
    if (m_state == "withdrawn") list[3].mark = Mark::refused;
    return list;
}

void ApprovalFlow::paint_disc(QPainter& painter, const QRectF& place, Mark mark) const {
    const qreal width = place.width() / 9;
    const QColor grey = palette().color(QPalette::Mid);
    if (mark == Mark::done || mark == Mark::refused) {
        painter.setPen(Qt::NoPen);
        painter.setBrush(mark == Mark::done ? green : vermilion);
    } else {
        painter.setPen(QPen(mark == Mark::waits ? blue : grey, mark == Mark::waits ? width : width / 2));
        painter.setBrush(palette().color(QPalette::Base));
    }
    painter.drawEllipse(place.adjusted(width / 2, width / 2, -width / 2, -width / 2));
    painter.setPen(QPen(Qt::white, width, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    const auto at = [&](qreal x, qreal y) {
        return QPointF(place.left() + x * place.width(), place.top() + y * place.height());
    };
    if (mark == Mark::done) painter.drawPolyline(QPolygonF{at(0.3, 0.52), at(0.45, 0.67), at(0.72, 0.36)});
    if (mark == Mark::refused) {
        painter.drawLine(at(0.35, 0.35), at(0.65, 0.65));
        painter.drawLine(at(0.65, 0.35), at(0.35, 0.65));
    }
    if (mark == Mark::waits) {
        painter.setBrush(blue);
        painter.setPen(Qt::NoPen);
        painter.drawEllipse(place.center(), width, width);
    }
}

void ApprovalFlow::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QList<Station> list = stations();
    const qreal line = fontMetrics().height(), side = line * 1.6,
                step = width() / static_cast<qreal>(list.size()), middle = line * 0.4 + side / 2;
    for (int k = 0; k + 1 < list.size(); ++k) {
        const bool behind = list[k + 1].mark == Mark::done || list[k + 1].mark == Mark::refused;
        painter.setPen(QPen(behind ? green : palette().color(QPalette::Mid), behind ? 3 : 1.5));
        painter.drawLine(QPointF(step * (k + 0.5) + side / 2, middle),
                         QPointF(step * (k + 1.5) - side / 2, middle));
    }
    for (int k = 0; k < list.size(); ++k) {
        paint_disc(painter, {step * (k + 0.5) - side / 2, middle - side / 2, side, side}, list[k].mark);
        QFont told = font();
        told.setBold(list[k].mark == Mark::waits || list[k].mark == Mark::refused);
        painter.setFont(told);
        painter.setPen(
            palette().color(list[k].mark == Mark::later ? QPalette::PlaceholderText : QPalette::WindowText));
        const QRectF place(step * k, middle + side / 2, step, line * 1.4);
        painter.drawText(place, Qt::AlignCenter,
                         QFontMetricsF(told).elidedText(list[k].title, Qt::ElideRight, step));
    }
}

}  // namespace weave::studio
