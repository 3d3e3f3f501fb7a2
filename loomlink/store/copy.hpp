#pragma once

#include <weave/core/result.hpp>

#include <string>

namespace weave::loomlink {

/// Copies a store from one place into another that holds none yet, be it a file or a database: every row with its numbers, as of
/// one moment, while `from` may be in use. Both are then read once more and compared, table by table. Whole or not at all.
/// Refused: a file that exists, a database that is not empty, and what the target cannot keep.
Status copy_store(const std::string& from, const std::string& to);

/// Takes away what copy_store() has just made, so that it can be made again.
Status remove_copy(const std::string& place);

/// copy_store() in place of the store that a database holds. Refused: one that is in use, and another program's.
Status replace_store(const std::string& from, const std::string& database);

}  // namespace weave::loomlink
