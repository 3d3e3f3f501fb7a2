#pragma once

#include <weave/curve/cloth_layout.hpp>
#include <weave/sim/plan.hpp>
#include <weave/sim/planned_points.hpp>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace weave::sim {

/// Control points of a planned yarn that follow one another.
struct Stretch {
    std::size_t yarn = 0;               ///< of the plan
    std::size_t first = 0, last = 0;    ///< the points that are its own, the last not included
    std::ptrdiff_t begin = 0;           ///< the point that stands first below: some before its own and after them, in a periodic yarn beyond its ends
    std::vector<Vec3> control;          ///< where each point lies itself, mm: not moved by turns of a periodic yarn
    std::vector<std::uint8_t> frozen;   ///< 1: held
};

/// A plan whose points are made stretch by stretch, for cloth of which no memory holds all points. What is known of each yarn and
/// of the scene is that of make_plan(), but for points, key points and crossings.
class PlanInStretches {
  public:
    /// How many others stand before and after a stretch's own points.
    static constexpr std::ptrdiff_t others = 3;
    static constexpr std::size_t usual_points = 2000;  ///< of a stretch

    /// As make_plan(), with its errors. The design and the block must outlive it.
    static Result<PlanInStretches> make(const Design& design, const Block& block, const SimulationRequest& request,
                                        std::size_t points_a_stretch = usual_points);

    [[nodiscard]] const Plan& plan() const { return m_plan; }
    /// How many control points and key points a yarn of the plan has.
    [[nodiscard]] std::size_t points(std::size_t yarn) const { return m_points->count(m_plan.curve_of[yarn]); }
    [[nodiscard]] std::size_t keys(std::size_t yarn) const { return m_points->keys(m_plan.curve_of[yarn]); }
    /// One point.
    [[nodiscard]] Vec3 point(std::size_t yarn, std::size_t index) const;
    /// A box around all points.
    [[nodiscard]] const Eigen::AlignedBox3d& box() const { return m_box; }
    /// Visits all stretches, yarn by yarn and along each. A point has the same bits in every one.
    void each_stretch(const std::function<void(const Stretch&)>& visit) const;
    /// Visits all crossings in the order of make_plan(); their yarns are those of the plan, `none` where one is not simulated.
    static constexpr std::size_t none = static_cast<std::size_t>(-1);
    void each_crossing(const std::function<void(const Crossing&)>& visit) const;

  private:
    friend class Planner;
    [[nodiscard]] Stretch stretch(std::size_t yarn, std::size_t first) const;

    Plan m_plan;
    Eigen::AlignedBox3d m_box;
    std::unique_ptr<const Block> m_repeat;  ///< where one repeat of the block is planned
    std::unique_ptr<const ClothLayout> m_layout;
    std::unique_ptr<const PlannedPoints> m_points;
};

}  // namespace weave::sim
