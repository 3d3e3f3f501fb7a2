#pragma once

#include <weave/core/result.hpp>

#include <cstdint>
#include <loomlink/workflow/caller.hpp>
#include <string>
#include <vector>

namespace weave::loomlink {

/// What can be done to a revision.
enum class Action : std::uint8_t { submit, comment, request_changes, waive, approve, release };

/// As the API names it, such as `request-changes`.
const char* word(Action action);

/// Whether this person may do this to a revision, by role, state and authorship: the whole matrix. What else
/// it takes (evidence, signatures of others) is not looked at. The error says what stands against it.
Status may(const Caller& caller, Action action, const Revision& revision);

/// The words of the actions that may() allows.
std::vector<std::string> allowed_actions(const Caller& caller, const Revision& revision);

bool is_author(const Caller& caller, const Revision& revision);

}  // namespace weave::loomlink
