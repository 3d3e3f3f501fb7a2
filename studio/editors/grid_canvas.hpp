#pragma once

#include <QWidget>

#include <optional>
#include <studio/editors/cell_picture.hpp>
#include <studio/editors/grid_region.hpp>
#include <studio/editors/grid_rulers.hpp>
#include <vector>

class QPainter;

namespace weave::studio {

/// What pressing and moving the mouse over squares does.
enum class GridTool : std::uint8_t { stroke, choose };

/// A grid of squares with rulers, which can be moved, zoomed and walked through with mouse and keys. It knows no weave.
class GridCanvas : public QWidget {
    Q_OBJECT
  public:
    explicit GridCanvas(QWidget* parent = nullptr);

    /// What fills the squares; the grid shows it so many times along rows and columns. The view stays where its size does, and where
    /// there is no picture for a while.
    void show_picture(CellPicture picture, int times_rows = 1, int times_columns = 1);
    /// Of the picture that is shown.
    void set_labels(GridLabels labels);
    /// Forgets where a person was, for another design.
    void begin_anew();
    void set_corner(Corner corner);
    /// What it says where there is no picture.
    void set_empty_text(const QString& text);
    /// The cell at which a person is; it is ringed, and brought into view.
    void set_cursor_cell(std::optional<GridCell> cell);
    [[nodiscard]] const std::optional<GridCell>& cursor_cell() const { return m_cursor; }
    /// Marks cells that refused, until the next press.
    void mark_refused(std::vector<GridCell> cells);
    [[nodiscard]] const std::vector<GridCell>& refused() const { return m_refused; }
    /// Whether pressing and drawing over cells gives strokes. Squares that are too small to be told apart give none.
    void set_can_stroke(bool can) { m_can_stroke = can; }
    static constexpr double smallest_stroked = 4;  ///< pixels of a square

    /// With another tool than that to choose nothing floats.
    void set_tool(GridTool tool);
    [[nodiscard]] GridTool tool() const { return m_tool; }
    /// What is chosen; no larger than the picture, even where that is shown several times.
    [[nodiscard]] const std::optional<GridRegion>& region() const { return m_region; }
    void choose_all();
    /// Nothing is chosen, nor floats.
    void let_go();
    /// A picture that lies over the grid, from this square on, until it is put down or dropped; keys and mouse move it.
    void show_floating(const QImage& picture, GridCell first);
    /// Squares that it covers; none where nothing floats.
    [[nodiscard]] std::optional<GridRegion> floating_region() const;
    /// Marks squares of it where it cannot be put down, until it moves.
    void mark_floating(std::vector<GridCell> refused);
    [[nodiscard]] const std::vector<GridCell>& floating_refused() const { return m_floating_refused; }

    [[nodiscard]] const GridMapping& mapping() const { return m_mapping; }
    void zoom_by(double factor);
    void zoom_in() { zoom_by(1.4); }
    void zoom_out() { zoom_by(1 / 1.4); }
    void fit();
    [[nodiscard]] QSize sizeHint() const override { return {560, 420}; }

  Q_SIGNALS:
    /// A click, or a line drawn with the button held, over these cells in their order.
    void stroked(const std::vector<weave::studio::GridCell>& cells);
    /// Chosen without being changed: a click with Ctrl, or the keys.
    void chosen(const weave::studio::GridCell& cell);
    /// Would have been a stroke, were the squares not too small.
    void too_far(const weave::studio::GridCell& cell);
    void hovered(const std::optional<weave::studio::GridCell>& cell);
    void menu_wanted(const weave::studio::GridCell& cell, const QPoint& where);
    void tool_changed();
    void region_changed();
    void floating_moved();
    /// It floats no more; where it is put down, that region is chosen.
    void floating_ended(bool is_put_down);

  protected:
    bool event(QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void leaveEvent(QEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void contextMenuEvent(QContextMenuEvent* event) override;

  private:
    static const QColor cursor_colour, refusal_colour;

    void lay_out();
    [[nodiscard]] bool is_far() const { return m_mapping.cell() < smallest_stroked; }
    void paint_lines(QPainter& painter) const;
    void paint_marks(QPainter& painter) const;
    void paint_region(QPainter& painter) const;
    void stroke_to(const GridCell& cell);
    void walk(int rows, int columns, bool is_shifted);
    void enter();
    [[nodiscard]] GridCell walked(GridCell from, int rows, int columns) const;
    void go_to(const GridCell& cell);
    void set_region(const std::optional<GridRegion>& region);
    [[nodiscard]] GridCell far_corner() const;
    void begin_choosing(const std::optional<GridCell>& cell, const QPointF& place);
    void choose_to(const QPointF& place);
    void end_choosing();
    void extend(int rows, int columns);
    void grasp_floating(const std::optional<GridCell>& cell);
    void drag_floating(const QPointF& place);
    void move_floating(const GridCell& first);
    void end_floating(bool is_put_down);

    CellPicture m_picture;
    GridMapping m_mapping;
    GridRulers m_rulers;
    QString m_empty_text;
    std::optional<GridCell> m_cursor, m_hovered;
    std::vector<GridCell> m_stroke, m_refused;
    std::optional<QPointF> m_moved_from;
    GridTool m_tool = GridTool::stroke;
    std::optional<GridRegion> m_region;
    GridCell m_anchor;                     ///< corner of the region that stays while it is drawn
    std::optional<QPointF> m_chosen_from;  ///< while the mouse draws it
    CellPicture m_floating;
    GridCell m_floating_first;
    std::vector<GridCell> m_floating_refused;
    std::optional<GridSize> m_grip;  ///< squares between the first that floats and the mouse that moves it
    bool m_can_stroke = true;
};

}  // namespace weave::studio
