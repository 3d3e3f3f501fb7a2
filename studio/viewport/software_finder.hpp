#pragma once

#include <weave/sim/execute.hpp>
#include <studio/viewport/picking.hpp>

#include <cstdint>
#include <vector>

namespace weave::studio {

/// Pieces in a row that one repeat shows.
struct PieceRange {
    std::uint32_t first = 0, count = 0;
    std::size_t i = 0, j = 0;  ///< the repeat, along x and y
};

/// What SoftwareFinder is asked for.
struct FindTask {
    Camera camera;
    PictureSize size;  ///< of what the camera's picture is, in any unit
    int width = 0, height = 0;
    double near = 0, far = 1;  ///< depths that become 0 and 1
    std::optional<Plane> clip;
    std::vector<PieceRange> ranges;
};

/// Finds which piece each pixel shows, on the processor, as the shaders vertex and find do: where there is no
/// graphics card, OpenGL takes ten times as long for it. The result does not depend on the number of threads.
class SoftwareFinder {
  public:
    SoftwareFinder();
    void run(const TubeModel& model, const FindTask& task);

    /// Two numbers a pixel, rows from the bottom, as the shader writes them: 1 + the piece; repeat and yarn.
    [[nodiscard]] const std::vector<std::uint32_t>& seen() const { return m_seen; }
    /// From 0 to 1.
    [[nodiscard]] const std::vector<float>& depth() const { return m_depth; }

    /// A plane in the camera's axes, of which what lies behind it is kept.
    struct Side {
        float x = 0, y = 0, z = 0, height = 0;
    };
    /// A piece as the camera sees it.
    struct Rod {
        float from[3], axis[3], radius, length2;
        float nearest;               ///< depth, 0 to 1
        int left, right, low, high;  ///< pixels, the last ones left out
        std::uint32_t seen[2];
        std::uint32_t sides, first_side;
    };

  private:
    void add_rods(const TubeModel& model, const FindTask& task);
    void sort_into_bands(const FindTask& task);
    void draw_band(const FindTask& task, std::size_t band);

    sim::ThreadTeam m_team;
    std::vector<std::uint32_t> m_seen;
    std::vector<float> m_depth;
    std::vector<Rod> m_rods;
    std::vector<Side> m_sides;
    std::vector<std::uint32_t> m_order;
    std::vector<std::vector<std::uint32_t>> m_bands;
};

}  // namespace weave::studio
