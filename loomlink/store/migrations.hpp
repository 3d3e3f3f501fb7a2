#pragma once

#include <weave/sql/migrations.hpp>

#include <span>

namespace weave::loomlink {

/// `db/migrations/*.sql` and `db/postgresql/*.sql`, built in, from version 1 on.
std::span<const sql::Migration> sqlite_migrations();
std::span<const sql::Migration> postgresql_migrations();

/// Those of an engine: the same tables and rules in its words, version by version.
inline std::span<const sql::Migration> migrations(sql::Engine engine = sql::Engine::sqlite) {
    return engine == sql::Engine::sqlite ? sqlite_migrations() : postgresql_migrations();
}

/// Marks a database as a store of loomlink ("WvLL").
inline constexpr sql::Owner store_owner{0x57764c4c, "loomlink"};

}  // namespace weave::loomlink
