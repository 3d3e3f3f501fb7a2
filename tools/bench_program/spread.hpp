#pragma once

#include <weave/core/json.hpp>

#include <vector>

namespace weave::bench {

/// The value that so great a part of sorted values does not exceed; 0 where there are none.
double percentile(const std::vector<double>& sorted, double part);

/// How times spread: `count`, `p50_ms`, `p99_ms`, `max_ms`.
Json spread_ms(std::vector<double> ms);

}  // namespace weave::bench
