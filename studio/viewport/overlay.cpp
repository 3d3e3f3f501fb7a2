#include <studio/viewport/overlay.hpp>

#include <weave/picture/colour_map.hpp>
#include <weave/picture/scale_marks.hpp>
#include <studio/viewport/words.hpp>

#include <QCoreApplication>
#include <QFontMetricsF>
#include <QLinearGradient>
#include <QPainter>
#include <QPainterPath>

#include <cmath>

namespace weave::studio {

namespace {

struct Words {
    Q_DECLARE_TR_FUNCTIONS(Viewport)
};

QColor colour_of(Colour colour) {
    return {colour.red, colour.green, colour.blue};
}

void paint_arrow(QPainter& painter, const QPointF& from, const QPointF& to, double width,
                 const QColor& colour) {
    const QPointF way = to - from;
    const double length = std::hypot(way.x(), way.y());
    if (length < 1) return;
    const QPointF along = way / length, across(-along.y(), along.x());
    const double head = 4.5 * width;
    painter.setPen(QPen(colour, width, Qt::SolidLine, Qt::RoundCap));
    painter.drawLine(from, to - along * head * 0.8);
    painter.setPen(Qt::NoPen);
    painter.setBrush(colour);
    painter.drawPolygon(
        QPolygonF{to, to - along * head + across * head * 0.42, to - along * head - across * head * 0.42});
}

}  // namespace

Overlay::Overlay(QPainter& painter, const QRectF& area, const QPalette& palette)
    : m_painter(painter), m_area(area) {
    const bool dark = palette.color(QPalette::Window).lightness() < 128;
    m_ink = dark ? QColor(236, 239, 242) : QColor(33, 40, 48);
    m_faint = dark ? QColor(168, 176, 185) : QColor(92, 101, 112);
    m_ground = dark ? QColor(30, 34, 39, 214) : QColor(255, 255, 255, 214);
    m_accent = dark ? QColor(0x56, 0xb4, 0xe9) : QColor(0x00, 0x72, 0xb2);
    m_left_top = area.top() + 0.8 * em();
    painter.setRenderHint(QPainter::Antialiasing);
}

double Overlay::em() const {
    return QFontMetricsF(m_painter.font()).height();
}

QRectF Overlay::plate(const QPointF& corner, const QString& text, const QColor& ink, double wide) {
    const QFontMetricsF metrics(m_painter.font());
    const double room = 0.45 * em();
    const QSizeF words = metrics.boundingRect(QRectF(0, 0, wide - 2 * room, 1e6), Qt::TextWordWrap, text).size();
    const QRectF place(corner, words + QSizeF(2 * room, 0.5 * room));
    m_painter.setPen(Qt::NoPen);
    m_painter.setBrush(m_ground);
    m_painter.drawRoundedRect(place, 0.3 * em(), 0.3 * em());
    m_painter.setPen(ink);
    m_painter.drawText(place.adjusted(room - 1, 0, 1 - room, 0), Qt::AlignCenter | Qt::TextWordWrap, text);
    return place;
}

void Overlay::legend(const TubeModel& model, double top) {
    if (!model.is_scalar()) return;
    const QFontMetricsF metrics(m_painter.font());
    const std::vector<double> marks = scale_marks(model.low(), model.high());
    double widest = 0;
    for (const double mark : marks)
        widest = std::max(widest, metrics.horizontalAdvance(QString::fromStdString(short_number(mark))));
    const QString title = scale_title(model.colour()),
                  note = model.values_are_old() ? Words::tr("before it moved") : QString();
    const double bar = 0.9 * em(), gap = 0.5 * em();
    const double height = std::min(11 * em(), m_area.bottom() - top - 5.5 * em());
    if (height < 3 * em()) return;  // no room for numbers that can be read
    const double lines = note.isEmpty() ? 1.3 : 2.3;
    const double wide =
        std::max({metrics.horizontalAdvance(title), metrics.horizontalAdvance(note), bar + gap + widest});
    const QRectF frame(m_area.right() - wide - 2.6 * gap, top, wide + 1.8 * gap,
                       height + (lines + 1.2) * em());
    m_painter.setPen(Qt::NoPen);
    m_painter.setBrush(m_ground);
    m_painter.drawRoundedRect(frame, 0.3 * em(), 0.3 * em());
    m_painter.setPen(m_ink);
    const double left = frame.left() + 0.9 * gap;
    m_painter.drawText(QPointF(left, top + 0.4 * gap + metrics.ascent()), title);
    m_painter.setPen(m_faint);
    if (!note.isEmpty()) m_painter.drawText(QPointF(left, top + 0.4 * gap + em() + metrics.ascent()), note);
    const QRectF scale(left, top + (lines + 0.4) * em(), bar, height);
    QLinearGradient gradient(scale.bottomLeft(), scale.topLeft());
    for (int k = 0; k <= 16; ++k) gradient.setColorAt(k / 16.0, colour_of(map_colour(k / 16.0)));
    m_painter.setPen(QPen(m_faint, 1));
    m_painter.setBrush(gradient);
    m_painter.drawRect(scale);
    m_painter.setPen(m_ink);
    for (const double mark : marks) {
        const double y =
            scale.bottom() - scale.height() * (mark - model.low()) / (model.high() - model.low());
        m_painter.drawLine(QPointF(scale.right(), y), QPointF(scale.right() + 0.5 * gap, y));
        m_painter.drawText(QRectF(scale.right() + gap, y - em() / 2, widest + gap, em()),
                           Qt::AlignLeft | Qt::AlignVCenter, QString::fromStdString(short_number(mark)));
    }
}

void Overlay::scale_bar(const Camera& camera) {
    if (camera.perspective) return;
    const double pixels_per_mm = camera.scale({m_area.width(), m_area.height()});
    const double length = round_step(9 * em() / pixels_per_mm), width = length * pixels_per_mm;
    const QPointF end(m_area.right() - 1.2 * em(), m_area.bottom() - 0.9 * em()),
        start = end - QPointF(width, 0);
    const double tick = 0.3 * em();
    m_painter.setPen(Qt::NoPen);
    m_painter.setBrush(m_ground);
    m_painter.drawRoundedRect(QRectF(start.x() - 0.5 * em(), end.y() - 1.6 * em(), width + em(), 2.1 * em()),
                              0.3 * em(), 0.3 * em());
    m_painter.setPen(QPen(m_ink, std::max(1.5, em() / 10), Qt::SolidLine, Qt::FlatCap));
    m_painter.drawLine(start, end);
    m_painter.drawLine(start - QPointF(0, tick), start + QPointF(0, tick));
    m_painter.drawLine(end - QPointF(0, tick), end + QPointF(0, tick));
    m_painter.drawText(QRectF(start.x() - 2 * em(), end.y() - 1.5 * em(), width + 4 * em(), 1.2 * em()),
                       Qt::AlignCenter, Words::tr("%1 mm").arg(QString::fromStdString(short_number(length))));
}

void Overlay::caption(const QString& text) {
    if (text.isEmpty()) return;
    const QFontMetricsF metrics(m_painter.font());
    const QString fitting = metrics.elidedText(text, Qt::ElideRight, m_area.width() - 12 * em());
    m_left_top = plate({m_area.left() + 0.8 * em(), m_left_top}, fitting, m_ink).bottom() + 0.4 * em();
}

void Overlay::padlock() {
    const double size = em();
    const QString text = QStringLiteral("      ") + Words::tr("View locked");
    const QRectF place = plate({m_area.left() + 0.8 * em(), m_left_top}, text, m_ink);
    const QPointF foot(place.left() + 0.95 * size, place.center().y() + 0.36 * size);
    m_painter.setPen(QPen(m_accent, 0.13 * size));
    m_painter.setBrush(Qt::NoBrush);
    m_painter.drawArc(QRectF(foot.x() - 0.22 * size, foot.y() - 0.86 * size, 0.44 * size, 0.6 * size), 0,
                      180 * 16);
    m_painter.setPen(Qt::NoPen);
    m_painter.setBrush(m_accent);
    m_painter.drawRoundedRect(QRectF(foot.x() - 0.34 * size, foot.y() - 0.5 * size, 0.68 * size, 0.5 * size),
                              0.08 * size, 0.08 * size);
    m_left_top = place.bottom() + 0.4 * em();
}

void Overlay::hint(const QString& text, double right) {
    if (text.isEmpty()) return;
    const double wide = QFontMetricsF(m_painter.font()).horizontalAdvance(text) + em();  // a little more than its plate has, which would break it else
    const double first = m_area.left() + 0.8 * em(), left = std::max(first, std::min(m_area.center().x() - wide / 2, right - wide));
    // Below what stands at the top left: at the bottom are the axes.
    m_left_top = plate({left, m_left_top}, text, m_accent, right - left).bottom() + 0.4 * em();
}

void Overlay::axes(const Camera& camera) {
    // Orange ends and blue picks, as by system.
    const QColor ends(0xd5, 0x5e, 0x00), picks = m_accent;
    const double length = 2.5 * em();
    const QPointF origin(m_area.left() + 5.8 * em(), m_area.bottom() - 3.9 * em());
    const auto arrow = [&](const Vec3& way, const QString& name, const QColor& colour) {
        const QPointF along(way.dot(camera.right()), -way.dot(camera.up()));
        const double seen = std::hypot(along.x(), along.y());
        if (seen < 0.12) return;  // it points at the viewer or away
        const QPointF tip = origin + along * length;
        paint_arrow(m_painter, origin, tip, std::max(1.6, em() / 9), colour);
        const QFontMetricsF metrics(m_painter.font());
        const double wide = metrics.horizontalAdvance(name);
        const QPointF at = tip + along / seen * (0.7 * em() + std::abs(along.x() / seen) * wide / 2);
        QPainterPath letters;
        letters.addText(at.x() - wide / 2, at.y() + 0.35 * metrics.ascent(), m_painter.font(), name);
        QColor halo = m_ground;
        halo.setAlpha(255);
        m_painter.strokePath(letters, QPen(halo, 0.22 * em(), Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
        m_painter.fillPath(letters, colour);
    };
    arrow(Vec3::UnitX(), Words::tr("picks"), picks);  // as the rulers of the card: the way in which they are counted
    arrow(Vec3::UnitY(), Words::tr("ends"), ends);
    arrow(Vec3::UnitZ(), Words::tr("face"), m_faint);
}

void Overlay::box(const Box& box, const Camera& camera, std::optional<Face> marked, const QString& label) {
    const PictureSize size{m_area.width(), m_area.height()};
    const auto outline = [&](Face face) {
        QPolygonF polygon;
        for (const Vec3& corner : corners_of(box, face)) {
            const Projected at = camera.project(corner, size);
            polygon << m_area.topLeft() + QPointF(at.x, at.y);
        }
        return polygon;
    };
    for (const Face face : all_faces) {
        if (!is_seen(box, face, camera)) continue;
        QColor line = m_accent, fill = m_accent;
        line.setAlpha(150);
        fill.setAlpha(face == marked ? 74 : 0);
        m_painter.setPen(QPen(line, face == marked ? 2.5 : 1.2, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
        m_painter.setBrush(fill);
        m_painter.drawPolygon(outline(face));
    }
    if (!marked || label.isEmpty()) return;
    const double wide = QFontMetricsF(m_painter.font()).horizontalAdvance(label) + 0.9 * em();
    const QPointF middle = outline(*marked).boundingRect().center();
    const double left =
        std::clamp(middle.x() - wide / 2, m_area.left(), std::max(m_area.left(), m_area.right() - wide));
    plate({left, middle.y() - 0.6 * em()}, label, m_ink);
}

void Overlay::message(const QString& title, const QString& text) {
    const QFont before = m_painter.font();
    QFont large = before;
    large.setPointSizeF(before.pointSizeF() * 1.35);
    large.setWeight(QFont::DemiBold);
    m_painter.setFont(large);
    m_painter.setPen(m_ink);
    const QRectF place = m_area.adjusted(2 * em(), 0, -2 * em(), 0);
    m_painter.drawText(QRectF(place.left(), m_area.center().y() - 2.2 * em(), place.width(), 2 * em()),
                       Qt::AlignHCenter | Qt::AlignBottom, title);
    m_painter.setFont(before);
    m_painter.setPen(m_faint);
    m_painter.drawText(QRectF(place.left(), m_area.center().y() + 0.4 * em(), place.width(), 8 * em()),
                       Qt::AlignHCenter | Qt::AlignTop | Qt::TextWordWrap, text);
}

}  // namespace weave::studio
