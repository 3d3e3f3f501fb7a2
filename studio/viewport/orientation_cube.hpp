#pragma once

#include <studio/viewport/block_faces.hpp>

#include <QPalette>
#include <QRectF>

#include <optional>

class QPainter;

namespace weave::studio {

/// A cube that turns as the cloth does, its sides named in words: it tells where one is, and a click on a
/// side looks at the cloth from there.
class OrientationCube {
  public:
    /// Where it is drawn, a square.
    void set_place(const QRectF& place) { m_place = place; }
    [[nodiscard]] const QRectF& place() const { return m_place; }
    void paint(QPainter& painter, const Camera& camera, const QPalette& palette,
               std::optional<Face> under_mouse) const;
    /// The side at a place of the widget.
    [[nodiscard]] std::optional<Face> at(const QPointF& place, const Camera& camera) const;

  private:
    [[nodiscard]] QPolygonF outline(Face face, const Camera& camera) const;
    QRectF m_place;
};

}  // namespace weave::studio
