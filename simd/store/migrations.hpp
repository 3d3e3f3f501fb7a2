#pragma once

#include <weave/sql/migrations.hpp>

#include <span>

namespace weave::simd {

/// `db/simd/*.sql`, built in, from version 1 on.
std::span<const sql::Migration> migrations();

/// Marks the file as a store of simd ("WvSD").
inline constexpr sql::Owner store_owner{0x57765344, "simd"};

}  // namespace weave::simd
