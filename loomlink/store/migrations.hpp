#pragma once

#include <loomlink/store/database.hpp>
#include <span>
#include <string_view>

namespace weave::loomlink::sql {

/// What brings a database from the version before to `version`.
struct Migration {
    int version;
    std::string_view script;
};

/// `db/migrations/*.sql`, built in, from version 1 on.
std::span<const Migration> migrations();

/// Marks the file as a store of loomlink ("WvLL").
inline constexpr int application_id = 0x57764c4c;

/// Brings a database to the last version, each step in a transaction of its own with its foreign keys
/// checked. An empty database becomes a store. Refused: a version newer than the last one, and another
/// program's database.
Status migrate(Connection& connection, std::span<const Migration> steps);

}  // namespace weave::loomlink::sql
