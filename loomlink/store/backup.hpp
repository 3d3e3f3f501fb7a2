#pragma once

#include <weave/core/result.hpp>

#include <filesystem>
#include <functional>
#include <string>

namespace weave::loomlink {

/// A new database that appears whole or not at all: `fill` gets the path of a temporary, empty file beside
/// `to`, readable by its owner alone, and leaves it closed. Refused where `to` exists.
Status make_database(const std::filesystem::path& to, const std::function<Status(const std::string&)>& fill);

/// Copies a database, in use or not, into a new file that appears whole or not at all. Refused where `to`
/// exists.
Status copy_database(const std::string& from, const std::filesystem::path& to);

/// Removes the file of a database that nobody has open, with what SQLite keeps beside it.
void remove_database(const std::filesystem::path& path);

}  // namespace weave::loomlink
