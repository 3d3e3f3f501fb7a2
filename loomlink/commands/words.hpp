#pragma once

#include <weave/core/json.hpp>

#include <string>
#include <vector>

namespace weave::loomlink {

/// What a member of an answer says to a person, on one line: a text or a number as it stands, the entries of
/// a list with commas between; empty where it is null or missing.
std::string told(const Json& json, const std::string& member);

/// The entries of a member that is a list; none where it is missing or something else.
std::vector<Json> entries(const Json& json, const std::string& member);

/// Lines of cells, the columns below one another. Cells are shown as on_one_line() shows them.
std::string in_columns(const std::vector<std::vector<std::string>>& lines);

/// The entries of a list as lines of these members.
std::string in_columns(const Json& json, const std::string& list, const std::vector<std::string>& members);

/// What a person who asked for a list sees of it: that there is nothing, where there is nothing.
std::string as_list(const std::string& lines);

}  // namespace weave::loomlink
