#pragma once

#include <studio/editors/bubble.hpp>
#include <studio/editors/grid_rulers.hpp>
#include <studio/editors/stencil_raster.hpp>

#include <QColor>
#include <QImage>
#include <QWidget>

#include <memory>
#include <optional>
#include <vector>

namespace weave::studio {

enum class StencilTool { pencil, line, rectangle, flood, choose };

/// The picture of a stencil, painted stack by stack. A stroke changes the picture at once and is told when
/// the button is released. Wheel: zoom; middle button, or Shift+wheel: move.
class StencilCanvas : public QWidget {
    Q_OBJECT
  public:
    explicit StencilCanvas(QWidget* parent = nullptr);

    void show_map(std::shared_ptr<const StencilMap> map, const std::vector<QColor>& colours);
    /// The blocks' names, for words about places.
    void set_names(const std::vector<QString>& names) { m_names = names; }
    void set_tool(StencilTool tool);
    void set_block(std::uint16_t block) { m_block = block; }
    /// A reason why nothing may be painted now; empty where it may.
    void set_obstacle(const QString& why) { m_obstacle = why; }
    [[nodiscard]] const StencilMap& map() const { return *m_map; }
    [[nodiscard]] const GridMapping& mapping() const { return m_mapping; }
    [[nodiscard]] StencilTool tool() const { return m_tool; }
    /// The middle of a stack's square in the widget; x its column, y its row.
    [[nodiscard]] QPoint place_of(QPoint stack) const;
    [[nodiscard]] QSize sizeHint() const override;
    void fit();
    void zoom_in() { zoom_by(1.5, m_mapping.room().center()); }
    void zoom_out() { zoom_by(1 / 1.5, m_mapping.room().center()); }
    void refuse(const QString& why, QPoint place);

  Q_SIGNALS:
    /// A stroke is done.
    void painted(std::shared_ptr<const weave::StencilMap> map, const QString& what);
    void block_chosen(std::uint16_t block);
    void status(const QString& words);

  protected:
    bool event(QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void leaveEvent(QEvent* event) override;

  private:
    [[nodiscard]] QPoint stack_at(QPointF place) const;
    [[nodiscard]] QRectF square_of(const QRect& stacks) const;
    void zoom_by(double factor, QPointF fixed);
    void changed(const QRect& stacks);
    void take_rows(const StencilMap& map);
    void begin_stroke(QPoint stack);
    void lead_stroke(QPoint stack);
    void end_stroke();
    void give_up_stroke();
    void draw_picture(QPainter& painter, const QRect& part) const;
    void draw_grid(QPainter& painter) const;
    void draw_wish(QPainter& painter) const;
    void choose(QPoint stack);
    void tell(QPoint stack);
    [[nodiscard]] QString name_of(std::uint16_t block) const;

    std::shared_ptr<StencilMap> m_map;           ///< as it is painted
    std::shared_ptr<const StencilMap> m_before;  ///< as it was shown, or told of last
    QImage m_image;                              ///< the same as colours, its bottom line is row 0
    std::vector<QColor> m_colours;
    std::vector<QString> m_names;
    QString m_obstacle;
    StencilTool m_tool = StencilTool::pencil;
    std::uint16_t m_block = 0;
    GridMapping m_mapping;
    GridRulers m_rulers;
    std::optional<QPoint> m_begin, m_last;  ///< of the stroke, as stacks
    std::optional<QPoint> m_cursor;         ///< the stack under the pointer, or that keys lead
    std::optional<QPointF> m_panning;
    bool m_stroke_changed = false;
    Bubble m_bubble;
};

}  // namespace weave::studio
