#pragma once

#include <weave/picture/canvas.hpp>

#include <span>
#include <vector>

namespace weave {

/// Finds places for words among what is drawn, so that none hides another.
class LabelPlaces {
  public:
    /// Words stay within this part of the picture.
    explicit LabelPlaces(const Rectangle& within) : m_within(within) {}

    void add_disc(Point centre, double radius) { m_discs.push_back({centre, radius}); }
    void add_words(const Rectangle& place) { m_words.push_back(place); }
    /// A chain of cubic Bézier pieces as Canvas::curve() draws it.
    void add_curve(std::span<const Point> bezier);

    /// What a straight line between two points would hide or run into: 0 where nothing.
    [[nodiscard]] double harm_along(Point from, Point to) const;

    /// Whether words of this size around one of the wishes would cover nothing.
    [[nodiscard]] bool fits(double width, double height, std::span<const Point> wishes) const;

    /// The first of the wishes, each the middle of words of this size, that covers nothing; where all do, the one
    /// that covers least. Words are hidden last of all, lines rather than discs. It is taken from now on.
    Rectangle take(double width, double height, std::span<const Point> wishes);

  private:
    struct Disc {
        Point centre;
        double radius = 0;
    };
    [[nodiscard]] double harm(const Rectangle& place) const;

    Rectangle m_within;
    std::vector<Rectangle> m_words;
    std::vector<Disc> m_discs;
    std::vector<Point> m_lines;  ///< points along the lines, every few pixels
};

}  // namespace weave
