#pragma once

#include <weave/core/result.hpp>

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace weave {

/// JSON values with object members kept in the order in which they stand in a file.
using Json = nlohmann::ordered_json;

/// Strict JSON: valid UTF-8, no repeated member names, at most 64 levels deep and 4,096 members an object.
/// Errors of writing name line and column. Takes a time that grows as the text does.
Result<Json> parse_json(std::string_view text);

/// The canonical bytes of a value after RFC 8785: members sorted by UTF-16 code units, numbers as ECMAScript
/// prints them, no spaces. Two values that mean the same have the same bytes, so their hash can stand for
/// them. Numbers must be finite; integers beyond 2^53 are rounded to double as the standard demands.
std::string canonical_json(const Json& value);

/// A double as ECMAScript's Number::toString prints it (RFC 8785, section 3.2.2.3). `value` must be finite.
std::string ecmascript_number(double value);

}  // namespace weave
