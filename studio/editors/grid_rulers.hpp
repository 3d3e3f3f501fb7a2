#pragma once

#include <studio/editors/grid_mapping.hpp>

#include <QPolygonF>
#include <QString>

#include <cstddef>
#include <functional>
#include <optional>

class QPainter;
class QWidget;

namespace weave::studio {

/// What rulers and lines of a grid say. Numbers are those of the first pick (end) of a row (column), from 0; also of the one after
/// the last.
struct GridLabels {
    QString row_word, column_word;  ///< `picks`, `ends`
    std::function<std::size_t(std::size_t)> number_of_row, number_of_column;
    /// Whether a heavier line lies before a row or column: where a stack of the block begins.
    std::function<bool(std::size_t)> row_begins, column_begins;
};

/// Labels of a grid whose rows and columns are numbered one by one.
GridLabels plain_labels(const QString& row_word, const QString& column_word);

/// Which numbers are printed beside which lines of a ruler, so that no two of them meet: not beside the seam of two repeats either,
/// where the last number would stand on the first. A line may hold several numbers, as a row of stacks several picks: where there is
/// no room for each line's first one, round ones stand beside the lines that hold them. Lengths in the window's pixels.
class PrintedNumbers {
  public:
    /// `room` is what a number takes; `repeat` are the lines after which the numbers begin again, `lines` all that there are;
    /// `most_in_line` the most numbers of a line.
    PrintedNumbers(double cell, double room, std::size_t repeat, std::size_t lines, std::size_t most_in_line = 1);
    /// What is printed beside a line with numbers from `first`, counted from 1, to one before `next`.
    [[nodiscard]] std::optional<std::size_t> beside(std::size_t line, std::size_t first, std::size_t next) const;

  private:
    double m_cell, m_room;
    std::size_t m_repeat, m_lines, m_step = 1;
};

/// The numbers and words beside a grid, and the triangle that shows where pick 1 is.
class GridRulers {
  public:
    /// Rows and columns are those of one repeat.
    void set(GridLabels labels, std::size_t rows, std::size_t columns);
    [[nodiscard]] const GridLabels& labels() const { return m_labels; }
    /// What the rulers leave of a widget.
    [[nodiscard]] QRectF room_in(const QWidget& widget, Corner corner) const;
    void paint(QPainter& painter, const QWidget& widget, const GridMapping& mapping) const;
    /// The triangle beside pick 1, or, where that is out of sight, at the end of the ruler that lies towards it.
    [[nodiscard]] QPolygonF origin(const QWidget& widget, const GridMapping& mapping) const;

  private:
    [[nodiscard]] double number_width(const QWidget& widget) const;  ///< of rows
    [[nodiscard]] double column_number_width(const QWidget& widget) const;
    void paint_row_numbers(QPainter& painter, const QWidget& widget, const GridMapping& mapping) const;
    void paint_column_numbers(QPainter& painter, const QWidget& widget, const GridMapping& mapping) const;

    GridLabels m_labels = plain_labels({}, {});
    std::size_t m_rows = 1, m_columns = 1;
    std::size_t m_most_in_row = 1, m_most_in_column = 1;
};

}  // namespace weave::studio
