#pragma once

#include <weave/sql/migrations.hpp>

#include <span>

namespace weave::loomlink {

/// `db/migrations/*.sql`, built in, from version 1 on.
std::span<const sql::Migration> migrations();

/// Marks the file as a store of loomlink ("WvLL").
inline constexpr sql::Owner store_owner{0x57764c4c, "loomlink"};

}  // namespace weave::loomlink
