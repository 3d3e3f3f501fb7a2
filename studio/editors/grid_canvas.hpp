#pragma once

#include <QWidget>

#include <functional>
#include <optional>
#include <studio/editors/cell_picture.hpp>
#include <studio/editors/grid_mapping.hpp>
#include <vector>

class QPainter;

namespace weave::studio {

/// What rulers and lines of a grid say. Numbers are those of the first pick (end) of a row (column), from 0.
struct GridLabels {
    QString row_word, column_word;  ///< `picks`, `ends`
    std::function<std::size_t(std::size_t)> number_of_row, number_of_column;
    /// Whether a heavier line lies before a row or column: where a stack of the block begins.
    std::function<bool(std::size_t)> row_begins, column_begins;
};

/// A grid of squares with rulers, which can be moved, zoomed and walked through with mouse and keys. It knows no weave.
class GridCanvas : public QWidget {
    Q_OBJECT
  public:
    explicit GridCanvas(QWidget* parent = nullptr);

    /// What fills the squares; the grid shows it so many times along rows and columns. The view stays where its size does.
    void show_picture(CellPicture picture, int times_rows = 1, int times_columns = 1);
    void set_labels(GridLabels labels);
    void set_corner(Corner corner);
    /// What it says where there is no picture.
    void set_empty_text(const QString& text);
    /// The cell at which a person is; it is ringed, and brought into view.
    void set_cursor_cell(std::optional<GridCell> cell);
    [[nodiscard]] const std::optional<GridCell>& cursor_cell() const { return m_cursor; }
    /// Marks a cell that refused, until the next press.
    void mark_refused(const GridCell& cell);
    /// Whether pressing and drawing over cells gives strokes.
    void set_can_stroke(bool can) { m_can_stroke = can; }

    [[nodiscard]] const GridMapping& mapping() const { return m_mapping; }
    void zoom_by(double factor);
    void fit();
    [[nodiscard]] QSize sizeHint() const override { return {560, 420}; }

  Q_SIGNALS:
    /// A click, or a line drawn with the button held, over these cells in their order.
    void stroked(const std::vector<weave::studio::GridCell>& cells);
    /// Chosen without being changed: a click with Ctrl, or the keys.
    void chosen(const weave::studio::GridCell& cell);
    void hovered(const std::optional<weave::studio::GridCell>& cell);
    void menu_wanted(const weave::studio::GridCell& cell, const QPoint& where);

  protected:
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
    [[nodiscard]] double ruler() const;
    void paint_lines(QPainter& painter) const;
    void paint_rulers(QPainter& painter) const;
    void paint_row_numbers(QPainter& painter) const;
    void paint_column_numbers(QPainter& painter) const;
    void paint_origin(QPainter& painter) const;
    void paint_marks(QPainter& painter) const;
    void stroke_to(const GridCell& cell);
    void walk(int rows, int columns);

    CellPicture m_picture;
    GridMapping m_mapping;
    GridLabels m_labels;
    QString m_empty_text;
    std::optional<GridCell> m_cursor, m_refused, m_hovered;
    std::vector<GridCell> m_stroke;
    std::optional<QPointF> m_moved_from;
    bool m_can_stroke = true;
};

}  // namespace weave::studio
