#pragma once

#include <weave/sim/device/relax_on.hpp>

#include <cstddef>
#include <vector>

namespace weave::sim {

/// What float forces are good for: below this residual their rounding counts.
inline constexpr double least_float_residual = 1e-4;

/// Counts a second relaxation, from where the first ended, into the result of both.
inline RelaxResult joined(const RelaxResult& first, RelaxResult second) {
    for (Progress& progress : second.history) {
        progress.iteration += first.iterations;
        progress.seconds += first.seconds;
    }
    second.history.insert(second.history.begin(), first.history.begin(), first.history.end());
    second.iterations += first.iterations;
    second.evaluations += first.evaluations;
    second.cg_iterations += first.cg_iterations;
    second.builds += first.builds;
    second.seconds += first.seconds;
    return second;
}

/// relax_on() with float forces as far as these lead, then with double ones where the goal is beyond.
template <class Machine>
RelaxResult relax_in_stages(Machine& machine, Energy<double>& energy, std::vector<double>& state, const RelaxOptions& options) {
    RelaxOptions rough = options;
    rough.residual = std::max(options.residual, least_float_residual);
    rough.leaves_saddles = options.leaves_saddles && rough.residual == options.residual;
    const RelaxResult first = relax_on<float>(machine, energy, state, rough);
    const bool leads_on = first.ending == Ending::converged || first.ending == Ending::stuck;
    if (!leads_on || (first.ending == Ending::converged && rough.residual == options.residual)) return first;
    RelaxOptions fine = options;
    fine.most_iterations -= std::min(fine.most_iterations, first.iterations);
    fine.most_seconds -= first.seconds;
    if (options.watch) {
        fine.watch = [&](Progress progress) {
            progress.iteration += first.iterations;
            progress.seconds += first.seconds;
            return options.watch(progress);
        };
    }
    return joined(first, relax_on<double>(machine, energy, state, fine));
}

}  // namespace weave::sim
