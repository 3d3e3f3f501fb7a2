#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace weave::sim {

/// How the simulator stands up to what it should never be asked: one catalogue, run by `weave bench
/// stability` and, the quick ones, by the tests.
struct ExtremeLimits {
    std::size_t most_iterations = 5000;
    double most_seconds = 30;
    std::size_t threads = 1;
};

/// What became of one case.
struct ExtremeEnd {
    bool refused = false;         ///< no simulation was begun
    bool converged = false;       ///< at rest, by the residual
    bool finite = true;           ///< every place, force and energy is a number
    bool passed_through = false;  ///< yarns passed through one another (linking.hpp, order.hpp)
    double residual = 0;
    double overlap = 0;        ///< greatest 1 - d/D of two yarns
    bool curves_down = false;  ///< at rest; see RelaxResult
    std::size_t points = 0, iterations = 0;
    double seconds = 0;
    std::string where;   ///< yarn and point of the greatest force, as the report of what is not at rest has them
    std::string report;  ///< what it ended as, and where; never empty
};

/// What must become of it. Whatever is expected: numbers stay numbers, time is kept, and no yarn passes
/// through another.
enum class Expected : std::uint8_t {
    rest,     ///< comes to rest
    told,     ///< may end otherwise; the report says what and where
    no_rest,  ///< must not claim to be at rest
    refused,
};

struct Extreme {
    std::string name;
    std::string about;  ///< what it is, in words
    Expected expected = Expected::rest;
    bool is_long = false;  ///< takes minutes, or gigabytes
    std::function<ExtremeEnd(const ExtremeLimits&)> run;
};

/// The whole catalogue (spec: stability tests).
std::vector<Extreme> extremes();

/// Whether a case ended as it must and within its limits; `why` says what is wrong.
bool is_good(const Extreme& extreme, const ExtremeEnd& end, const ExtremeLimits& limits, std::string& why);

}  // namespace weave::sim
