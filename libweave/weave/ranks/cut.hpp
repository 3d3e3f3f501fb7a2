#pragma once

#include <weave/sim/plan_in_stretches.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace weave::ranks {

/// A control point of a cloth, wherever it is worked on.
struct Point {
    std::uint32_t yarn = 0;   ///< of the plan
    std::uint32_t index = 0;  ///< along the yarn
    std::uint32_t block = 0;  ///< that it belongs to, for good
    bool is_frozen = false;
    Vec3 planned{0, 0, 0};    ///< mm
};

/// A point as a block meets it: itself, `turns` times the whole of its closed yarn further along it and moved by so many
/// periods besides.
struct Met {
    Point point;
    std::int32_t turns = 0;
    std::array<std::int16_t, 2> image{};
};

/// What a block has of its own: points by yarn and along it, and those of others that its segments reach.
struct Part {
    std::vector<Point> own;
    std::vector<Met> along;  ///< the three points before and after each run of its own
};

/// How a cloth is cut into blocks of rows and columns: by where its points are planned, in strips of rows with as many points
/// each, and these again in blocks of columns. The number of blocks follows from the points alone, never from who works on
/// them, so that nothing that is computed block by block depends on it.
struct Cut {
    std::array<std::size_t, 2> blocks{1, 1};  ///< strips along x, and blocks in each
    std::vector<sim::SimYarn> yarns;          ///< of the plan, without their points
    std::vector<std::uint32_t> points;        ///< of each yarn
    sim::SimScene terms;                      ///< what else is simulated: no yarns
    std::array<double, 2> low{}, high{};      ///< of all planned places, seen from above
    std::string sha256;                       ///< of all planned places and which are held: what tells this plan from any other

    [[nodiscard]] std::size_t count() const { return blocks[0] * blocks[1]; }
    /// Whether a point may move: a yarn of one point is no curve.
    [[nodiscard]] bool moves(const Point& point) const { return !point.is_frozen && (points[point.yarn] > 1 || yarns[point.yarn].is_periodic); }
    /// The blocks of a rank: from the first on, before the last.
    [[nodiscard]] std::array<std::size_t, 2> blocks_of(std::size_t rank, std::size_t ranks) const {
        return {count() * rank / ranks, count() * (rank + 1) / ranks};
    }
    [[nodiscard]] std::size_t rank_of(std::size_t block, std::size_t ranks) const { return ((block + 1) * ranks - 1) / count(); }
};

/// Points of a block if nothing else is said: few enough for many ranks, many enough for little rim.
inline constexpr std::size_t usual_points = 4096;

/// Cuts a plan, and gives the parts of the blocks of a rank, which never holds other points than these. It makes all stretches of the
/// plan three times: no rank waits for another.
/// Errors: what is not relaxed in parts: friction, periods that relax.
struct CutPlan {
    Cut cut;
    std::vector<Part> parts;  ///< of the blocks of this rank
};
Result<CutPlan> cut_plan(const sim::PlanInStretches& plan, std::size_t rank, std::size_t ranks, std::size_t points_a_block = usual_points);

}  // namespace weave::ranks
