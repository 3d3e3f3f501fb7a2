#pragma once

#include <weave/picture/grid.hpp>

#include <cstddef>
#include <vector>

namespace weave {

/// A ring in a picture; lengths in pixels.
struct Ring {
    Point centre;
    double radius = 0;
};

/// Finds changes on a grid that nobody would see where the whole picture is looked at, since they are a pixel
/// or a few of thousands, and what to ring so that they are found. Changes close by get one ring together.
class ChangeRings {
  public:
    /// `grid` must outlive this.
    explicit ChangeRings(const Grid& grid);

    /// The square of this row and column has changed.
    void add(std::size_t row, std::size_t column);

    /// None for changes that are large enough to be seen, and none at all where there would be so many that
    /// they hid the card.
    [[nodiscard]] std::vector<Ring> rings() const;

    /// Width of a ring's line, for this size of picture.
    [[nodiscard]] double line() const;

  private:
    /// What the changes in one square of the picture cover.
    struct Bin {
        double area = 0, left = 0, right = 0, top = 0, bottom = 0;
        [[nodiscard]] bool used() const { return area > 0; }
        void cover(const Bin& other);
    };
    [[nodiscard]] double longest() const;
    /// Calls visit(bin) for a bin and those that touch it.
    template <class Visit>
    void each_neighbour(std::size_t bin, Visit visit) const;
    /// Whether the changes in a bin are part of a patch that is large enough to be seen.
    [[nodiscard]] bool is_seen(std::size_t bin) const;

    const Grid* m_grid;
    double m_reach;  ///< least radius of a ring, and the side of a bin
    std::size_t m_across, m_down;
    std::vector<Bin> m_bins;  ///< row by row from the top left
};

}  // namespace weave
