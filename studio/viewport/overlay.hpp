#pragma once

#include <studio/viewport/block_faces.hpp>
#include <studio/viewport/tube_model.hpp>

#include <QPalette>
#include <QRectF>
#include <QString>

#include <optional>

class QPainter;

namespace weave::studio {

/// What is written over the yarns. Every function draws with the painter's font, whose size is the measure of
/// everything.
class Overlay {
  public:
    Overlay(QPainter& painter, const QRectF& area, const QPalette& palette);

    /// The colour scale under `top`, at the right; what it measures, with its unit.
    void legend(const TubeModel& model, double top);
    /// A bar of a round length at the bottom right; not with perspective, where lengths depend on depth.
    void scale_bar(const Camera& camera);
    /// How much is shown: top left.
    void caption(const QString& text);
    /// A padlock with a word, top left under the caption.
    void padlock();
    /// What can be done now: under what stands at the top left, in several lines where `right` leaves too little room.
    void hint(const QString& text, double right);
    /// Where the ends and the picks run: arrows at the bottom left.
    void axes(const Camera& camera);
    /// The box's sides that can be seen as lines; one of them filled, with a label.
    void box(const Box& box, const Camera& camera, std::optional<Face> marked, const QString& label);
    /// Words in the middle, for want of a picture.
    void message(const QString& title, const QString& text);

  private:
    [[nodiscard]] double em() const;
    /// Text on a pale plate, at its top left corner, in lines of `wide` at most; the plate's place.
    QRectF plate(const QPointF& corner, const QString& text, const QColor& ink, double wide = 1e6);
    QPainter& m_painter;
    QRectF m_area;
    QColor m_ink, m_faint, m_ground, m_accent;
    double m_left_top;  ///< where the next thing at the top left begins
};

}  // namespace weave::studio
