#include <weave/sql/migrations.hpp>

#include <algorithm>

namespace weave::sql {

namespace {

Status refuse_foreign(Connection& connection, const Stamp& stamp, const Owner& owner) {
    if (stamp.application == owner.application_id) return {};
    WEAVE_TRY(const bool empty, connection.is_empty());
    if (stamp.application == 0 && stamp.version == 0 && empty) return {};
    return Error{ErrorCode::refused,
                 "is another program's database, not a store of " + std::string(owner.program),
                 {}};
}

Status apply(Connection& connection, const Migration& step, const Owner& owner) {
    WEAVE_CHECK_OK(connection.script(std::string(step.script)));
    bool is_whole = true;
    WEAVE_CHECK_OK(connection.inspect_links([&](const std::string&, const std::string&) { is_whole = false; }));
    if (!is_whole) return system_fault("migration " + std::to_string(step.version) + " would leave dangling links");
    return connection.set_stamp({owner.application_id, step.version});
}

/// Applies the steps that are still to come when the lock is held, since another program may have been first.
Status step_up(Connection& connection, const Migration& step, const Owner& owner) {
    WEAVE_CHECK_OK(connection.begin_write());
    const auto stamp = connection.stamp();
    Status status = !stamp                           ? Status(stamp.error())
                    : stamp->version >= step.version ? Status()
                                                     : apply(connection, step, owner);
    if (status) status = connection.commit();
    if (!status) connection.rollback();
    return status;
}

}  // namespace

Status can_migrate(Connection& connection, std::span<const Migration> steps, const Owner& owner) {
    WEAVE_TRY(const Stamp stamp, connection.stamp());
    WEAVE_CHECK_OK(refuse_foreign(connection, stamp, owner));
    if (stamp.version <= steps.back().version) return {};
    return Error{ErrorCode::refused,
                 "is a store of version " + std::to_string(stamp.version) + "; this program knows up to " +
                     std::to_string(steps.back().version),
                 {}};
}

Status migrate(Connection& connection, std::span<const Migration> steps, const Owner& owner) {
    WEAVE_CHECK_OK(can_migrate(connection, steps, owner));
    WEAVE_TRY(const Stamp stamp, connection.stamp());
    for (const Migration& step : steps)
        if (step.version > stamp.version) WEAVE_CHECK_OK(step_up(connection, step, owner));
    return {};
}

}  // namespace weave::sql
