#pragma once

#include <weave/sql/database.hpp>

#include <simd/store/records.hpp>
#include <string>

namespace weave::simd {

/// A number as SQLite holds it. One beyond its range comes out negative, which the tables refuse.
inline std::int64_t whole(Number number) {
    return static_cast<std::int64_t>(number);
}
inline std::optional<std::int64_t> whole(const std::optional<Number>& number) {
    return number ? std::optional(whole(*number)) : std::nullopt;
}

inline Number number_at(const sql::Row& row, int column) {
    return static_cast<Number>(row.integer(column));
}
inline std::optional<Number> optional_number_at(const sql::Row& row, int column) {
    return row.is_null(column) ? std::nullopt : std::optional(number_at(row, column));
}
inline std::optional<std::string> optional_text_at(const sql::Row& row, int column) {
    return row.is_null(column) ? std::nullopt : std::optional(row.bytes(column));
}

/// `session 7` is not there.
inline Error no_such(const std::string& thing, Number number) {
    return {ErrorCode::usage, "there is no such " + thing, thing + " " + std::to_string(number)};
}

/// What a person's request made, if it was answered before.
Result<std::optional<Made>> made_before(sql::Connection& connection, const std::string& person,
                                        const std::string& request);

/// Remembers an answer unless there is one, and forgets the oldest of the person's.
Status remember_answer(sql::Connection& connection, const std::string& person, const std::string& request,
                       const std::string& answer, std::optional<Number> made);

}  // namespace weave::simd
