#include <studio/viewport/orientation_cube.hpp>

#include <studio/viewport/words.hpp>

#include <QPainter>
#include <QPainterPath>
#include <QTransform>

namespace weave::studio {

namespace {

const Box unit_box{{-1, -1, -1}, {1, 1, 1}};

/// The cube is always seen from far away, so that it does not look like another thing near the rim.
Camera from_far(Camera camera) {
    camera.perspective = false;
    camera.centre = Vec3::Zero();
    camera.height_mm = 3.6;
    return camera;
}

QPointF on_screen(const Vec3& place, const Camera& camera, const QRectF& square) {
    const Projected at = camera.project(place, {square.width(), square.height()});
    return {square.x() + at.x, square.y() + at.y};
}

/// From a square of side 1, seen straight on, to the side as it lies now; so that words stand upright and
/// read rightly.
QTransform side_transform(Face face, const Camera& camera, const QRectF& square) {
    const Camera straight = facing(face, camera);
    const Vec3 middle = normal_of(face), right = straight.right(), up = straight.up();
    const QPointF corner = on_screen(middle - right + up, camera, square),
                  end = on_screen(middle + right + up, camera, square),
                  foot = on_screen(middle - right - up, camera, square);
    return {end.x() - corner.x(),  end.y() - corner.y(), foot.x() - corner.x(),
            foot.y() - corner.y(), corner.x(),           corner.y()};
}

void paint_name(QPainter& painter, Face face, const Camera& camera, const QRectF& square, const QColor& ink) {
    QFont font = painter.font();
    font.setPixelSize(40);
    font.setWeight(QFont::DemiBold);
    QPainterPath letters;
    letters.addText(0, 0, font, face_name(face));
    const QRectF bounds = letters.boundingRect();
    // In a square of side 1: letters are as large on all sides, and end before the edge.
    const double size = std::min(0.0062, 0.86 / bounds.width());
    QTransform in_square;
    in_square.translate(0.5 - size * bounds.center().x(), 0.5 - size * bounds.center().y());
    in_square.scale(size, size);
    painter.fillPath((in_square * side_transform(face, camera, square)).map(letters), ink);
}

}  // namespace

QPolygonF OrientationCube::outline(Face face, const Camera& camera) const {
    QPolygonF polygon;
    for (const Vec3& corner : corners_of(unit_box, face))
        polygon << on_screen(corner, from_far(camera), m_place);
    return polygon;
}

void OrientationCube::paint(QPainter& painter, const Camera& camera, const QPalette& palette,
                            std::optional<Face> under_mouse) const {
    const Camera far = from_far(camera);
    const bool dark = palette.color(QPalette::Window).lightness() < 128;
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    for (const Face face : all_faces) {
        if (!is_seen(unit_box, face, far)) continue;
        const double front = -normal_of(face).dot(far.away());
        QColor fill = dark ? QColor(58 + int(44 * front), 64 + int(46 * front), 72 + int(48 * front))
                           : QColor(206 + int(46 * front), 212 + int(41 * front), 220 + int(34 * front));
        if (under_mouse == face) fill = palette.color(QPalette::Highlight);
        fill.setAlpha(242);
        painter.setPen(QPen(dark ? QColor(20, 23, 27) : QColor(120, 129, 140), m_place.width() / 90,
                            Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
        painter.setBrush(fill);
        painter.drawPolygon(outline(face, camera));
        if (front < 0.16) continue;  // too narrow to read
        const QColor ink = under_mouse == face ? palette.color(QPalette::HighlightedText)
                           : dark              ? QColor(238, 241, 244)
                                               : QColor(38, 45, 54);
        paint_name(painter, face, far, m_place, ink);
    }
    painter.restore();
}

std::optional<Face> OrientationCube::at(const QPointF& place, const Camera& camera) const {
    if (!m_place.contains(place)) return std::nullopt;
    for (const Face face : all_faces) {
        if (is_seen(unit_box, face, from_far(camera)) &&
            outline(face, camera).containsPoint(place, Qt::OddEvenFill))
            return face;
    }
    return std::nullopt;
}

}  // namespace weave::studio
