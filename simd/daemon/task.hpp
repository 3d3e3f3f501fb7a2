#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>

#include <optional>
#include <simd/link/work_order.hpp>
#include <string>

namespace weave::simd {

/// How a worker came to its end.
struct WorkerEnd {
    std::string how;               ///< as a process, in words
    std::optional<Error> failure;  ///< what it told of before
    bool is_final = false;         ///< the same would happen again
};

/// A session or a job, as the crew sees it. All is called under the daemon's lock.
class Task {
  public:
    Task() = default;
    virtual ~Task() = default;
    Task(const Task&) = delete;
    Task& operator=(const Task&) = delete;

    /// What its worker is to do, which is starting now.
    virtual WorkOrder order() = 0;
    /// What the worker has planned, which waits to be admitted.
    virtual void planned(const Json& plan) = 0;
    /// Anything else that it says; `what` is the member `say`.
    virtual void said(const std::string& what, const Json& message) = 0;
    virtual void shown(std::string frame) = 0;
    /// The worker is no more.
    virtual void ended(const WorkerEnd& end) = 0;
};

}  // namespace weave::simd
