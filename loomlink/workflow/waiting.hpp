#pragma once

#include <loomlink/workflow/desk.hpp>

namespace weave::loomlink {

/// What waits for a person, by role; faults of woven releases too, for who made the revision. `items`: of
/// each `what`, `state`, `since`, and `design` with `revision`, or `design`, `loom` and `release`.
Result<Json> waiting_for(Desk& desk, const Caller& caller);

}  // namespace weave::loomlink
