#pragma once

#include <weave/sql/database.hpp>

#include <span>
#include <string_view>

namespace weave::sql {

/// What brings a database from the version before to `version`.
struct Migration {
    int version;
    std::string_view script;
};

/// Whose database it is.
struct Owner {
    int application_id;        ///< marks the file, as `PRAGMA application_id`
    std::string_view program;  ///< for messages
};

/// Whether migrate() would take a database. Refused: a version newer than the last one, and another program's database.
Status can_migrate(Connection& connection, std::span<const Migration> steps, const Owner& owner);

/// Brings a database to the last version, each step in a transaction of its own with its foreign keys
/// checked. An empty database becomes the owner's. Refused as of can_migrate().
Status migrate(Connection& connection, std::span<const Migration> steps, const Owner& owner);

}  // namespace weave::sql
