#pragma once

#include <weave/sql/database.hpp>

namespace weave::sql {

/// A connection to a database of PostgreSQL (15 or later), by libpq. What it promises beside Connection:
/// - A commit is durable on the standbys that the server waits for, and readable there (synchronous_commit = remote_apply).
///   One that the server does not confirm within `patience`, or only warns of, is an error: it may have been stored.
/// - Writers come one after the other, by an advisory lock of the database, whatever else the tables' own rules hold.
/// - No error and no log line holds the connection string, only names of database and host.
/// Errors: bad_input for a string that libpq does not understand or that holds a password; system where no server answers,
/// where it is a standby that should take writes, and in a program built without libpq.
Result<std::unique_ptr<Connection>> open_postgres(const std::string& place, Access access,
                                                  std::chrono::milliseconds patience);

/// The servers that a place names, each as a place of its own.
Result<std::vector<std::string>> servers_of(const std::string& place);

}  // namespace weave::sql
