#pragma once

#include <weave/core/json.hpp>

#include <string>
#include <vector>

namespace weave::loomlink {

/// A record of the log, as the server's `GET /events` lists it, as cells of one line for an engineer: number,
/// moment, who, what, to what, and in the last one all else: what the record says besides (`revision 3, loom
/// "EP 1"`), the reason, and who signed with which key. Texts that could be taken for more than one are
/// quoted; hashes and keys are told by their first 16 characters; what has parts of its own stands in the
/// JSON alone.
std::vector<std::string> log_cells(const Json& record);

}  // namespace weave::loomlink
