#pragma once

#include "bench_measure.hpp"

namespace weave::program {

struct ScaleOptions {
    std::size_t least = 500, most = 1'000'000;
    double residual = 1e-3;
};

/// A five-end satin in two layers, tiled to more and more points and not reduced, from a start with noise of
/// 0.05 radius: time, memory and steps at each size, and the exponents that fit. It ends at a size that does
/// not come to rest in time.
Result<Json> measure_scale(const BenchOptions& options, const ScaleOptions& scale);
std::string scale_table(const Json& result);

}  // namespace weave::program
