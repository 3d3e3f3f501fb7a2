#pragma once

#include <weave/core/result.hpp>

#include <filesystem>
#include <loomlink/audit/bundle.hpp>
#include <vector>

namespace weave::loomlink {

/// Whether the tables of a store say what its log tells: the log is read from its first record on, what
/// people, designs, looms and releases came to by it is worked out anew, and every row that is missing, is
/// more, or says something else is told, with the records that lack what their kind must tell and steps that
/// were not signed by the key that the person had then. The log itself is verify_store()'s. Reads the file and
/// changes nothing, also while it is in use. Empty: all well.
Result<std::vector<AuditFinding>> verify_tables(const std::string& store);

}  // namespace weave::loomlink
