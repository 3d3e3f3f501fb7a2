#pragma once

#include <QPointF>
#include <QRectF>
#include <QSizeF>

#include <cstddef>
#include <cstdint>
#include <optional>

namespace weave::studio {

/// The corner of a picture at which pick 1 and end 1 meet.
enum class Corner : std::uint8_t { bottom_left, bottom_right, top_left, top_right };

/// A square of a grid, from 0.
struct GridCell {
    std::size_t row = 0, column = 0;
    friend bool operator==(const GridCell&, const GridCell&) = default;
};

/// So many of them.
struct GridSize {
    std::size_t rows = 1, columns = 1;
};

/// Cells that are seen: first and one past the last.
struct GridSpan {
    std::size_t first_row = 0, last_row = 0, first_column = 0, last_column = 0;
};

/// Where the squares of a grid of rows and columns lie in a window, whatever its corner and scale. Lengths in the window's
/// (device independent) pixels.
class GridMapping {
  public:
    static constexpr double largest_cell = 64, smallest_cell = 1.0 / 64;

    void set_grid(std::size_t rows, std::size_t columns);
    void set_corner(Corner corner) { m_corner = corner; }
    /// The part of the window that the grid has.
    void set_room(const QRectF& room);

    [[nodiscard]] std::size_t rows() const { return m_rows; }
    [[nodiscard]] std::size_t columns() const { return m_columns; }
    [[nodiscard]] Corner corner() const { return m_corner; }
    [[nodiscard]] const QRectF& room() const { return m_room; }
    /// Side of a square.
    [[nodiscard]] double cell() const { return m_cell; }
    /// The whole grid.
    [[nodiscard]] QRectF frame() const;

    /// All of it, as large as it goes, in the middle.
    void fit();
    [[nodiscard]] bool is_fitted() const { return m_is_fitted; }
    /// Larger by a factor, what lies at `fixed` staying there.
    void zoom(double factor, const QPointF& fixed);
    void move(const QPointF& by);
    /// Moves no more than it must for a cell to be seen.
    void show(const GridCell& cell);

    [[nodiscard]] std::optional<GridCell> cell_at(const QPointF& place) const;
    /// The same, or the nearest cell that is seen.
    [[nodiscard]] GridCell nearest_cell(const QPointF& place) const;
    [[nodiscard]] QRectF box(const GridCell& cell) const;
    /// Where a row or column begins, counted from the corner; also of the one after the last.
    [[nodiscard]] double y_of(double row) const;
    [[nodiscard]] double x_of(double column) const;
    [[nodiscard]] GridSpan seen() const;
    /// That of a smaller grid which lies on this one, its first cell on `first`.
    [[nodiscard]] GridMapping of_part(const GridCell& first, const GridSize& size) const;

    [[nodiscard]] bool rows_go_up() const { return m_corner == Corner::bottom_left || m_corner == Corner::bottom_right; }
    [[nodiscard]] bool columns_go_right() const { return m_corner == Corner::bottom_left || m_corner == Corner::top_left; }

  private:
    void keep_in_sight();

    std::size_t m_rows = 1, m_columns = 1;
    Corner m_corner = Corner::bottom_left;
    QRectF m_room{0, 0, 1, 1};
    double m_cell = 16;
    QPointF m_left_top;  ///< of the grid
    bool m_is_fitted = true;
};

}  // namespace weave::studio
