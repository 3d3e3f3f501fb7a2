#pragma once

#include <weave/picture/canvas.hpp>

#include <vector>

namespace weave {

/// A place in a block: x counts rows, y columns, z levels.
struct Place {
    double x = 0, y = 0, z = 0;
};

/// Looks at a block from the front left and above, without perspective: x runs to the back right, y to the
/// front right.
class Viewpoint {
  public:
    /// Pixels of one stack, and the share of it that one level is high.
    explicit Viewpoint(double scale, double level_height = 0.42) : m_scale(scale), m_level(level_height) {}
    [[nodiscard]] Point on_screen(Place place) const;
    /// How far away a place is; only comparisons mean anything.
    [[nodiscard]] double distance(Place place) const;
    void move_origin(Point origin) { m_origin = origin; }

  private:
    double m_scale, m_level;
    Point m_origin;
};

/// A short piece of round yarn in space.
struct Tube {
    std::vector<Place> places;  ///< two or more
    Colour colour;
    double radius = 6;    ///< pixels
    double distance = 0;  ///< set by draw_tubes
};

/// Draws tubes with nearer ones over farther ones, with dark rims and a light along the top.
void draw_tubes(Canvas& canvas, const Viewpoint& view, std::vector<Tube> tubes);

}  // namespace weave
