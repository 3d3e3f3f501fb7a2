#pragma once

#include <weave/sim/device/relax_on.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace weave::sim {

/// What float forces are good for: below this residual their rounding counts.
inline constexpr double least_float_residual = 1e-4;

/// What float forces are asked for on the way to a goal.
inline RelaxOptions in_float(const RelaxOptions& options) {
    RelaxOptions rough = options;
    rough.residual = std::max(options.residual, least_float_residual);
    rough.leaves_saddles = options.leaves_saddles && rough.residual == options.residual;
    return rough;
}

/// Whether double forces lead on from where float ones ended.
inline bool leads_on(const RelaxResult& first, const RelaxOptions& options) {
    return first.ending == Ending::stuck || (first.ending == Ending::converged && options.residual < least_float_residual);
}

/// What is left for double forces. `options` and `first` must stay.
inline RelaxOptions in_double(const RelaxOptions& options, const RelaxResult& first) {
    RelaxOptions fine = options;
    fine.most_iterations -= std::min(fine.most_iterations, first.iterations);
    fine.most_seconds -= first.seconds;
    if (options.watch) {
        fine.watch = [&options, &first](Progress progress) {
            progress.iteration += first.iterations;
            progress.seconds += first.seconds;
            return options.watch(progress);
        };
    }
    return fine;
}

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
    const RelaxResult first = relax_on<float>(machine, energy, state, in_float(options));
    if (!leads_on(first, options)) return first;
    return joined(first, relax_on<double>(machine, energy, state, in_double(options, first)));
}

/// The same with relax_each_on(). Those that go on in double begin when all have ended in float.
template <class Machine>
std::vector<RelaxResult> relax_each_in_stages(Machine& machine, std::span<const ClothToRelax> cloths) {
    std::vector<ClothToRelax> rough(cloths.begin(), cloths.end()), fine;
    for (ClothToRelax& cloth : rough) cloth.options = in_float(cloth.options);
    std::vector<RelaxResult> results = relax_each_on<float>(machine, std::span<const ClothToRelax>(rough));
    std::vector<std::size_t> which;
    for (std::size_t k = 0; k < cloths.size(); ++k) {
        if (!leads_on(results[k], cloths[k].options)) continue;
        which.push_back(k);
        fine.push_back({cloths[k].energy, cloths[k].state, in_double(cloths[k].options, results[k])});
    }
    std::vector<RelaxResult> second = relax_each_on<double>(machine, std::span<const ClothToRelax>(fine));
    for (std::size_t k = 0; k < which.size(); ++k) results[which[k]] = joined(results[which[k]], std::move(second[k]));
    return results;
}

}  // namespace weave::sim
