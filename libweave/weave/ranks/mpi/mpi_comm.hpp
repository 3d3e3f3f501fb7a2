#pragma once

#include <weave/core/result.hpp>
#include <weave/ranks/comm.hpp>

#include <chrono>
#include <functional>
#include <memory>
#include <string>

namespace weave::ranks {

/// Whether mpirun, or srun, started this process as one of several.
bool is_one_of_many();

/// Joins the other processes that were started together. Ranks that do not answer for `patience` are lost, as where the network
/// between them is cut: then `tell_lost` is called with the cause, and all of them are ended with exit code 5. Errors: this
/// program was built without MPI, or MPI cannot begin.
Result<std::unique_ptr<Comm>> join_others(std::chrono::seconds patience, std::function<void(const std::string&)> tell_lost);

}  // namespace weave::ranks
