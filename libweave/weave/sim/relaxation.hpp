#pragma once

#include <weave/sim/execute.hpp>
#include <weave/sim/plan.hpp>
#include <weave/sim/relax.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace weave::sim {

/// What a person may change of a yarn system while its cloth relaxes.
struct LiveParameters {
    double strain = 1.01;  ///< S of fed yarns, 1 to 2
    double stiffness = 1;  ///< factor on EA and EI of the plan, above 0
    double radius = 1;     ///< factor on the radii of the plan, above 0
};

/// A relaxation that goes on while its parameters change. What was asked for is reached by and by, a part of the way
/// each time the yarns have given way, so that no jump makes them pass through one another. Slip against friction counts
/// from the beginning of each part.
class Relaxation {
  public:
    /// `threads`: 0 for one a core. The plan is copied.
    explicit Relaxation(const Plan& plan, std::size_t threads = 0);

    /// Asks for other parameters of a system; run() leads there. Errors: out of range. Of yarns of fixed length the strain
    /// counts for nothing.
    Status set(System system, const LiveParameters& wanted);
    [[nodiscard]] const LiveParameters& now(System system) const { return m_now[index_of(system)]; }

    /// The scene as it is now, control points included.
    [[nodiscard]] const SimScene& scene() const { return m_scene; }

    /// Leads to the parameters that were asked for and relaxes. Stopped by options.watch it keeps what it has reached, and
    /// the next run goes on from there.
    RelaxResult run(const RelaxOptions& options);

  private:
    static std::size_t index_of(System system) { return system == System::warp ? 0 : 1; }
    bool approach();
    void apply();
    RelaxResult relax_now(const RelaxOptions& options);

    Executor m_executor;
    SimScene m_plan, m_scene;
    std::vector<System> m_system;  ///< of each yarn
    std::array<LiveParameters, 2> m_now, m_wanted;
};

}  // namespace weave::sim
