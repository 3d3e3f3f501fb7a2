#pragma once

#include <studio/editors/bubble.hpp>
#include <studio/editors/slice_paint.hpp>
#include <studio/editors/slice_view.hpp>

#include <QWidget>

#include <functional>

namespace weave::studio {

/// Shows a slice, zooms and moves it, and points out what lies under the pointer. What can be done with it
/// the heirs know. Wheel: zoom; Shift+wheel, or dragging with the middle button: move; + − F: zoom in, out,
/// fit.
class SliceCanvas : public QWidget {
    Q_OBJECT
  public:
    explicit SliceCanvas(QWidget* parent = nullptr);

    [[nodiscard]] const SliceScene& scene() const { return m_scene; }
    [[nodiscard]] const SliceView& view() const { return m_view; }
    [[nodiscard]] const SliceMarks& marks() const { return m_marks; }
    /// Where a yarn's place lies in the widget.
    [[nodiscard]] QPoint place_of(std::size_t position, double level) const;
    [[nodiscard]] QSize sizeHint() const override;

    /// Shows the whole slice, if it can be told apart.
    void fit();
    void zoom_in() { zoom_by(1.25); }
    void zoom_out() { zoom_by(0.8); }
    /// Brings a position to the left side.
    void go_to(std::size_t position);
    /// Brings a position to the middle, unless all of the slice is seen.
    void centre_on(std::size_t position);
    /// The first position that can be seen, and how many.
    [[nodiscard]] std::pair<std::size_t, std::size_t> seen() const;

  Q_SIGNALS:
    /// What lies under the pointer, or what came of a gesture, in words.
    void status(const QString& words);
    /// Another part of the slice is seen.
    void moved();

  protected:
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void leaveEvent(QEvent* event) override;

    /// Shows another scene; the view stays where it is.
    void set_scene(SliceScene scene);
    /// Lays out what is seen now; for heirs that lay out parts.
    virtual void lay_out() {}
    /// Tells what lies at a place; `yarn` is under the pointer.
    virtual void hover(QPointF place, std::optional<SliceYarnId> yarn) = 0;
    /// What an empty slice says in its middle.
    [[nodiscard]] virtual QString empty_words() const { return {}; }

    /// Tells what lies under the pointer, unless a bubble says why something could not be done: that stays.
    void tell(const QString& words);
    /// Says at a place why something cannot be done, and in the status line.
    void refuse(const QString& why, QPoint place);
    /// The middle of a marked yarn, or of the widget.
    [[nodiscard]] QPoint place_of_marks() const;
    void reveal(const SliceYarnId& yarn);
    [[nodiscard]] QRectF space() const;
    void begin_panning(QPointF place);
    [[nodiscard]] bool is_panning() const { return m_panning.has_value(); }
    SliceMarks m_marks;

  private:
    void zoom_by(double factor);
    void view_moved();
    [[nodiscard]] QRectF ruler() const;
    SliceScene m_scene;
    SliceView m_view;
    Bubble m_bubble;
    std::optional<QPointF> m_panning;  ///< where the pointer was last
    bool m_fitted = false;             ///< the view has been set for a scene
};

}  // namespace weave::studio
