#pragma once

#include <string>
#include <vector>

namespace weave::gpu_bench {

/// Something measured.
struct Figure {
    std::string name;
    double value;
    std::string unit;
    std::string how;  ///< of what, how often, which of the times
};

/// A case measures one thing in some ways; about a second each. A new one is a function here and a line in main.cpp.
std::vector<Figure> measure_copy();      ///< bandwidth of a plain copy within the device's memory
std::vector<Figure> measure_launches();  ///< what a launch costs, and an answer from the device
std::vector<Figure> measure_barriers();  ///< what waiting for one another costs the blocks of a gang

}  // namespace weave::gpu_bench
