#pragma once

#include <weave/core/result.hpp>
#include <weave/sql/database.hpp>

#include <chrono>
#include <loomlink/store/log_mark.hpp>
#include <memory>
#include <string>

namespace weave::loomlink {

// What holds only for a store on a server, which others use too.

/// Whether a place is a connection string of PostgreSQL, not the path of a file.
bool is_database(const std::string& place);

/// Whether it is a connection string that can be used: of PostgreSQL, and without a password in it.
Status check_connection_string(const std::string& place);

/// Refused: a store that programs of loomlink have open, on whatever machine, and still have after some seconds: what has just ended
/// is in nobody's way. A file's program is known by the lock of its
/// folder instead.
Status refuse_in_use(const std::string& place);

/// Clocks may differ by so much; a record tells when it was written by the clock of the machine that serves.
inline constexpr std::chrono::minutes clock_allowance{5};

/// Refused: a clock (`now`, since 1970) that differs from that of the database by more than clock_allowance.
Status check_clock(sql::Connection& connection, std::chrono::milliseconds now);

/// A connection for writing, to the one primary among the servers of a place. Refused: two servers of the place that both
/// take writes, and as of LogMark::check() and check_clock().
Result<std::unique_ptr<sql::Connection>> open_writer(const std::string& place, const LogMark& mark);

/// Waits, not long, until a standby shows all that the primary had made durable when this was asked. False: it lags.
/// Refused: what is no standby.
Result<bool> catches_up(sql::Connection& standby, sql::Connection& primary);

}  // namespace weave::loomlink
