#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>
#include <weave/net/message.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace weave::loomlink {

/// What a member of a request's body, or a parameter of its query, is.
enum class FieldKind : std::uint8_t {
    text,
    secret,  ///< a text that no message repeats
    integer,
    number,
    yes_or_no,
    texts,     ///< a list
    integers,  ///< a list
    document,  ///< JSON as it stands, or the text of it
};

/// One member or parameter: from this a request is checked and the API document made.
struct Field {
    std::string name;
    std::string description;
    FieldKind kind = FieldKind::text;
    bool required = true;  ///< else it may be missing, or null in a body
    std::int64_t low = 1;  ///< least number; least bytes of a text; least entries of a list
    std::int64_t high = 200;
    std::vector<std::string> choices{};  ///< the texts that it may be; empty: any
};
using Fields = std::vector<Field>;

/// `field` may be missing.
Field optional(Field field);

/// The body of a request, held to its fields: a JSON object with them and no others. Members that are null
/// are left out. Errors (bad_input) name the member and repeat no value.
Result<Json> read_body(std::string_view body, const Fields& fields);

/// The same for the parameters of a query, each given at most once; numbers become numbers.
Result<Json> read_query(const net::Parameters& query, const Fields& fields);

/// A JSON Schema (draft 2020-12) of one field.
Json schema_of(const Field& field);

/// A JSON Schema of an object with these fields and no others.
Json schema_of(const Fields& fields);

}  // namespace weave::loomlink
