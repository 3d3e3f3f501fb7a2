#pragma once

#include <studio/editors/slice_scene.hpp>

#include <QPainterPath>
#include <QPointF>
#include <QRectF>

#include <cstddef>
#include <optional>
#include <vector>

namespace weave::studio {

/// Where the places of a slice lie in a widget: zoomed and moved. Lengths in the widget's pixels.
class SliceView {
  public:
    /// `unit` is the height of the letters' lines, by which everything scales at zoom 1.
    void set_unit(double unit) { m_unit = unit; }

    [[nodiscard]] double zoom() const { return m_zoom; }
    [[nodiscard]] double across() const { return 3.1 * m_unit * m_zoom; }  ///< between positions
    [[nodiscard]] double up() const { return 1.85 * m_unit * m_zoom; }     ///< between levels
    [[nodiscard]] double radius() const { return 0.7 * m_unit * m_zoom; }  ///< of a dot
    [[nodiscard]] double path_width() const { return 0.36 * m_unit * m_zoom; }

    [[nodiscard]] QPointF at(double position, double level) const;
    [[nodiscard]] double position_at(double x) const { return (x - m_origin.x()) / across(); }
    [[nodiscard]] double level_at(double y) const { return (m_origin.y() - y) / up(); }
    /// The position whose column a place lies in, if the slice has it.
    [[nodiscard]] std::optional<std::size_t> column_at(double x, std::size_t positions) const;

    void move_by(QPointF distance) { m_origin += distance; }
    /// Zooms so that what lies at `fixed` stays there.
    void zoom_by(double factor, QPointF fixed);
    /// Shows all positions and levels in `space`, if they can be told apart there; else the first positions.
    void fit(const SliceScene& scene, const QRectF& space);
    /// Brings a place into `space` with the least movement.
    void reveal(double position, double level, const QRectF& space);
    /// Keeps some of the slice within `space`.
    void keep_in(const SliceScene& scene, const QRectF& space);

    static constexpr double least_zoom = 0.12, most_zoom = 6;

  private:
    QPointF m_origin{80, 200};  ///< of position 0, level 0
    double m_zoom = 1, m_unit = 15;
};

/// How far beyond the outermost position a path that reaches the edge is drawn, in positions.
inline constexpr double path_overhang = 0.62;

/// The line of a path through these levels, `first` being the position of the first one; `aside` says between
/// which levels it steps aside, by how much of a position.
QPainterPath curve_of(const SliceView& view, std::size_t first, const std::vector<double>& levels,
                      const std::vector<double>& aside, bool left_end, bool right_end);
/// The line of a path of a scene between two positions that it runs through.
QPainterPath curve_of(const SliceView& view, const SliceScene& scene, const ScenePath& path, std::size_t from,
                      std::size_t to);

/// The yarn at a place of the widget: a dot before a path.
std::optional<SliceYarnId> yarn_at(const SliceView& view, const SliceScene& scene, QPointF place);
/// The path whose line, or number at its left end, is nearest to a place, within reach of a hand.
std::optional<std::size_t> path_at(const SliceView& view, const SliceScene& scene, QPointF place);

/// How many dots of a position lie below a level.
std::size_t dots_below(const SliceScene& scene, std::size_t position, double level);
const ScenePath* path_of(const SliceScene& scene, std::size_t number);
const SceneDot* dot_of(const SliceScene& scene, const SliceYarnId& yarn);

}  // namespace weave::studio
