#pragma once

#include <weave/core/result.hpp>
#include <weave/net/message.hpp>

#include <string>
#include <string_view>

namespace weave::net {

/// What a percent-encoded text stands for. Errors (bad_input): `%` without two hexadecimal digits; a result
/// that is no UTF-8 or has control characters. A `+` stays a `+`.
Result<std::string> percent_decoded(std::string_view text);

/// `text` as it may stand in a segment of a path or in a query: all but letters, digits and `-._~` encoded.
std::string percent_encoded(std::string_view text);

/// A request target taken apart.
struct Target {
    std::string path;  ///< decoded, `/api/v1/designs`
    Parameters query;
};

/// Reads a request target in origin form, `/path?query`. Errors (bad_input): another form; characters that
/// must be encoded; a segment that is empty (but for `/` itself), `.` or `..`, or that hides a slash, a
/// backslash or a control character behind its encoding; more than 64 parameters.
Result<Target> parse_target(std::string_view target);

/// The parameters of a query or of a form's body (application/x-www-form-urlencoded: `+` is a space). Errors
/// as above.
Result<Parameters> parse_query(std::string_view query);

}  // namespace weave::net
