#pragma once

// Every test of what runs on devices is written once, over a machine:
//
//   struct MyKernel { View<double> out; template <class Crew> WEAVE_HD void operator()(Crew& crew) const { … } };
//   TEMPLATE_TEST_CASE("what it shows", "[device]", WEAVE_MACHINES) {
//       TestType machine;
//       Array<double> out(machine.memory, 10);
//       machine.run(MyKernel{out.view()});
//       CHECK(out.get() == …);
//   }
//
// It stands in a header, SUBJECT.hpp; SUBJECT.cpp includes that header for the machines of the processor, SUBJECT.cu for those of a
// device. Names of functors are of the file (an unnamed namespace); bodies are never lambdas.

#include <catch2/catch.hpp>

#include "host_machines.hpp"
#if defined(__CUDACC__)
#include "device_machines.cuh"
#endif

namespace device_tests {

/// Whether all of WEAVE_MACHINES come to the same bits as one thread of the processor, where only bodies count. A device does not:
/// nvcc makes one rounding of a product and a sum.
#if defined(__CUDACC__)
inline constexpr bool round_as_one_thread = false;
#else
inline constexpr bool round_as_one_thread = true;
#endif

}  // namespace device_tests
