#pragma once

#include <weave/sim/plan.hpp>
#include <weave/sim/relax.hpp>
#include <weave/sim/yarns.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>

namespace weave::sim {

enum class Solver : std::uint8_t {
    relax,  ///< damped Newton steps (relax.hpp)
    paper,  ///< motion in time, as the paper did it (paper.hpp): slow, the baseline
};

Result<Solver> parse_solver(std::string_view text);
std::string_view name_of(Solver solver);

struct SimulationOptions {
    Solver solver = Solver::relax;
    std::size_t threads = 0;            ///< 0: one a core
    std::optional<double> residual;     ///< instead of the fidelity's
    std::size_t most_iterations = 2000;
    double most_seconds = 1e30;
    std::function<bool(const Progress&)> watch;  ///< see RelaxOptions
};

/// Relaxes a plan. The yarns hold the whole cloth: a smallest repeat is copied back. Their report has the keys of
/// `weave simulate --json`; whether it converged, and whether every crossing kept its order, is in it. What the report
/// says is measured on the last state, whatever the ending.
Yarns simulate(const Design& design, const Plan& plan, const SimulationOptions& options);

}  // namespace weave::sim
