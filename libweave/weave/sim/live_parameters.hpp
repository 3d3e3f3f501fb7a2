#pragma once

#include <weave/sim/plan.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace weave::sim {

/// What a person may change of a yarn system while its cloth relaxes.
struct LiveParameters {
    double strain = 1.01;  ///< S of fed yarns, 1 to 2
    double stiffness = 1;  ///< factor on EA and EI of the plan, above 0
    double radius = 1;     ///< factor on the radii of the plan, above 0
    friend bool operator==(const LiveParameters&, const LiveParameters&) = default;
};

/// The parameters of both systems on their way to what was asked for. They move a part of the way each time the yarns have
/// given way, so that no jump makes yarns pass through one another.
class LedParameters {
  public:
    /// Those of the plan.
    explicit LedParameters(const Plan& plan);

    /// Asks for others. Errors: out of range. Of yarns of fixed length the strain counts for nothing.
    Status ask(System system, const LiveParameters& wanted);
    [[nodiscard]] const LiveParameters& now(System system) const { return m_now[index_of(system)]; }
    [[nodiscard]] const LiveParameters& wanted(System system) const { return m_wanted[index_of(system)]; }
    [[nodiscard]] bool have_arrived() const { return m_now == m_wanted; }

    /// Moves them on by one part; whether any moved.
    bool approach();
    /// Gives a scene of the plan's yarns the parameters of now.
    void apply(SimScene& scene) const;

    /// Takes up where another run of the same plan was.
    void restore(System system, const LiveParameters& now, const LiveParameters& wanted);

  private:
    static std::size_t index_of(System system) { return system == System::warp ? 0 : 1; }

    struct Planned {
        System system = System::warp;
        double stretch_N = 0, bending_N_mm2 = 0, radius_mm = 0;
    };
    std::vector<Planned> m_yarns;
    std::array<LiveParameters, 2> m_now, m_wanted;
};

}  // namespace weave::sim
