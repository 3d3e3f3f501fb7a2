#pragma once

#include <weave/net/message.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace weave::net {

/// How the body of a request is delimited.
struct Framing {
    bool chunked = false;
    std::uint64_t length = 0;  ///< if not chunked
    [[nodiscard]] bool has_body() const { return chunked || length > 0; }
};

/// Holds the raw bytes of a request's head, up to and with the empty line, to what two programs in a row
/// cannot read differently; parsers, Beast's among them, forgive much of it. Errors (bad_input): a bare CR or
/// LF, a control character, a folded line, a space before a colon, a nameless field, another line than
/// `METHOD TARGET HTTP/1.x` at the start. Source: RFC 9112, sections 2.2, 3, 5.1, 5.2.
Status check_head(std::string_view head);

/// The framing that the fields announce. Errors (bad_input): more than one Content-Length or
/// Transfer-Encoding, or both; a length that is not all digits; a coding other than `chunked`, or any in
/// HTTP/1.0. Source: RFC 9112, 6.3.
Result<Framing> framing_of(const Headers& headers, bool version_1_0);

/// Checks that there is exactly one Host field (HTTP/1.0 may have none), shaped as a host with or without a
/// port, and gives the host without its port, in lower case. Errors: bad_input.
Result<std::string> host_of(const Headers& headers, bool version_1_0);

/// What the connection adds to an answer's head.
struct HeadContext {
    bool secure = false;  ///< adds Strict-Transport-Security
    bool keep_alive = false;
    std::string date;  ///< as http_date gives it
};

/// The answer itself; or, where a header field of it cannot be sent (a line break or another control
/// character in it), a 500 in its place, told to the log.
Response sendable(Response response);

/// The head of a sendable answer, with length, date, connection and the security headers it does not bring
/// itself. Length, date and connection are always the server's own.
std::string written_head(const Response& response, const HeadContext& context);

/// A time as HTTP writes it, `Sun, 06 Nov 1994 08:49:37 GMT`.
std::string http_date(std::int64_t seconds_since_1970);

}  // namespace weave::net
