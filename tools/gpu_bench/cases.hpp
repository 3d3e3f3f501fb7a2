#pragma once

#include <weave/sim/device/relax_device.hpp>

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

/// A case measures one thing in some ways. A new one is a function here and a line in main.cpp.
using Figures = std::vector<Figure>;

// Of a device alone.
Figures measure_copy();      ///< bandwidth of a plain copy within the device's memory
Figures measure_launches();  ///< what a launch costs, and an answer from the device
Figures measure_barriers();  ///< what waiting for one another costs the blocks of a gang
Figures measure_contact();   ///< bandwidth of the pass over contact samples

// Of whatever relaxes.
Figures measure_table1(sim::DeviceRelaxer& relaxer);  ///< the structures of the paper's Table 1 to `standard`, beside the processor
Figures measure_batch(sim::DeviceRelaxer& relaxer);   ///< many small cells, from starts of their own, and one of them alone
Figures measure_live(sim::DeviceRelaxer& relaxer);    ///< pictures a second of cloths of some 10,000 points while they relax
Figures measure_large(sim::DeviceRelaxer& relaxer);   ///< a million points to `standard`

}  // namespace weave::gpu_bench
