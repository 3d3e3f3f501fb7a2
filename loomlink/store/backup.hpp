#pragma once

#include <weave/core/result.hpp>

#include <filesystem>
#include <string>

namespace weave::loomlink {

/// Copies a database, in use or not, into a new file that appears whole or not at all. Refused where `to`
/// exists.
Status copy_database(const std::string& from, const std::filesystem::path& to);

}  // namespace weave::loomlink
