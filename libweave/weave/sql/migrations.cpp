#include <weave/sql/migrations.hpp>

namespace weave::sql {

namespace {

Status refuse_foreign(Connection& connection, std::int64_t version, const Owner& owner) {
    WEAVE_TRY(const std::int64_t id, connection.number("PRAGMA application_id"));
    if (id == owner.application_id) return {};
    WEAVE_TRY(const std::int64_t tables, connection.number("SELECT count(*) FROM sqlite_schema"));
    if (id == 0 && version == 0 && tables == 0) return {};
    return Error{ErrorCode::refused,
                 "is another program's database, not a store of " + std::string(owner.program),
                 {}};
}

Status apply(Connection& connection, const Migration& step, const Owner& owner) {
    WEAVE_CHECK_OK(connection.script(std::string(step.script)));
    WEAVE_TRY(const std::int64_t dangling,
              connection.number("SELECT count(*) FROM pragma_foreign_key_check"));
    if (dangling > 0)
        return system_fault("migration " + std::to_string(step.version) + " would leave dangling links");
    return connection.script("PRAGMA application_id = " + std::to_string(owner.application_id) +
                             "; PRAGMA user_version = " + std::to_string(step.version));
}

/// Applies the steps that are still to come when the lock is held, since another program may have been first.
Status step_up(Connection& connection, const Migration& step, const Owner& owner) {
    WEAVE_CHECK_OK(connection.script("BEGIN IMMEDIATE"));
    const auto version = connection.number("PRAGMA user_version");
    Status status = !version                   ? Status(version.error())
                    : *version >= step.version ? Status()
                                               : apply(connection, step, owner);
    if (status) status = connection.script("COMMIT");
    if (!status && connection.in_transaction()) static_cast<void>(connection.script("ROLLBACK"));
    return status;
}

}  // namespace

Status migrate(Connection& connection, std::span<const Migration> steps, const Owner& owner) {
    WEAVE_TRY(const std::int64_t version, connection.number("PRAGMA user_version"));
    WEAVE_CHECK_OK(refuse_foreign(connection, version, owner));
    if (version > steps.back().version)
        return Error{ErrorCode::refused,
                     "is a store of version " + std::to_string(version) + "; this program knows up to " +
                         std::to_string(steps.back().version),
                     {}};
    for (const Migration& step : steps)
        if (step.version > version) WEAVE_CHECK_OK(step_up(connection, step, owner));
    return {};
}

}  // namespace weave::sql
