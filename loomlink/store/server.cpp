#include <loomlink/store/server.hpp>

#include <weave/core/text.hpp>
#include <weave/sql/postgres.hpp>

#include <thread>

namespace weave::loomlink {

namespace {

using namespace std::chrono;

constexpr milliseconds patience_with_standby{50}, pause{1};
/// The server lists a session for a moment longer than its program lived.
constexpr milliseconds patience_with_ending{5000}, glance{50};

Status refuse_two_primaries(const std::string& place) {
    WEAVE_TRY(const auto servers, sql::servers_of(place));
    if (servers.size() < 2) return {};
    std::size_t primaries = 0;
    for (const std::string& server : servers)
        if (sql::Connection::open(server, sql::Access::write)) ++primaries;
    if (primaries < 2) return {};
    return Error{ErrorCode::refused,
                 "two of the servers take writes: one was promoted while the other lives, or came back. Stop the old one before "
                 "anything else, and see \"Two primaries\" in loomlink/RUNBOOK.md",
                 {}};
}

}  // namespace

bool is_database(const std::string& place) {
    return sql::engine_of(place) == sql::Engine::postgres;
}

Status check_connection_string(const std::string& place) {
    if (!is_database(place) || on_one_line(place) != place)
        return bad_input("must be a connection string of PostgreSQL, such as postgresql://db.mill.example/mill");
    const auto servers = sql::servers_of(place);
    return servers ? Status() : Status(servers.error());
}

Status check_clock(sql::Connection& connection, milliseconds now) {
    WEAVE_TRY(const std::int64_t theirs,
              connection.number("SELECT CAST(extract(epoch FROM clock_timestamp()) * 1000 AS bigint)"));
    const milliseconds ahead = now - milliseconds(theirs);
    if (ahead <= clock_allowance && ahead >= -clock_allowance) return {};
    return Error{ErrorCode::refused,
                 "the clock of this machine is " + std::to_string(duration_cast<seconds>(ahead < milliseconds(0) ? -ahead : ahead).count()) +
                     " seconds " + (ahead < milliseconds(0) ? "behind" : "ahead of") +
                     " that of the database: set both (NTP), since records tell when something happened and looms judge by it",
                 {}};
}

Status refuse_in_use(const std::string& place) {
    if (!is_database(place)) return {};
    WEAVE_TRY(const auto connection, sql::Connection::open(place, sql::Access::read));
    for (const auto end = steady_clock::now() + patience_with_ending; true; std::this_thread::sleep_for(glance)) {
        WEAVE_TRY(const std::int64_t others,
                  connection->number("SELECT count(*) FROM pg_stat_activity WHERE datname = current_database() AND application_name = "
                                     "'weave' AND pid <> pg_backend_pid()"));
        if (others == 0) return {};
        if (steady_clock::now() > end) return Error{ErrorCode::refused, "is in use; stop every program that has it open", place};
    }
}

Result<std::unique_ptr<sql::Connection>> open_writer(const std::string& place, const LogMark& mark) {
    const bool is_server = is_database(place);
    if (is_server) WEAVE_CHECK_OK(refuse_two_primaries(place));
    WEAVE_TRY(auto connection, sql::Connection::open(place, sql::Access::write));
    if (!is_server) return connection;
    WEAVE_CHECK_OK(check_clock(*connection, duration_cast<milliseconds>(system_clock::now().time_since_epoch())));
    WEAVE_CHECK_OK(mark.check(*connection));
    return connection;
}

Result<bool> catches_up(sql::Connection& standby, sql::Connection& primary) {
    WEAVE_TRY(const auto written, primary.one("SELECT CAST(pg_current_wal_flush_lsn() AS text)",
                                              [](const sql::Row& row) { return row.bytes(0); }));
    WEAVE_TRY(const std::int64_t follows, standby.number("SELECT pg_is_in_recovery()"));
    if (follows == 0) return Error{ErrorCode::refused, "is no standby: it takes writes itself", {}};
    const auto end = steady_clock::now() + patience_with_standby;
    while (true) {
        WEAVE_TRY(const std::int64_t has,
                  standby.number("SELECT pg_last_wal_replay_lsn() >= CAST(? AS pg_lsn)", written.value_or("")));
        if (has != 0) return true;
        if (steady_clock::now() > end) return false;
        std::this_thread::sleep_for(pause);
    }
}

}  // namespace weave::loomlink
