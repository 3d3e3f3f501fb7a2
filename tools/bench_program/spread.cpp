#include "spread.hpp"

#include <algorithm>
#include <cmath>

namespace weave::bench {

double percentile(const std::vector<double>& sorted, double part) {
    if (sorted.empty()) return 0;
    const double rank = std::ceil(part * static_cast<double>(sorted.size()));
    return sorted.at(static_cast<std::size_t>(std::max(rank, 1.0)) - 1);
}

Json spread_ms(std::vector<double> ms) {
    std::sort(ms.begin(), ms.end());
    return {{"count", ms.size()}, {"p50_ms", percentile(ms, 0.5)}, {"p99_ms", percentile(ms, 0.99)}, {"max_ms", percentile(ms, 1)}};
}

}  // namespace weave::bench
