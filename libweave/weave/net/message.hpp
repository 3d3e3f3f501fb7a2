#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace weave::net {

/// Bytes that many answers may share without a copy. Null stands for no bytes.
using Bytes = std::shared_ptr<const std::string>;

/// `text` as shareable bytes.
Bytes make_bytes(std::string text);

/// Header fields in the order in which they came or will be sent; names are compared without regard to case.
class Headers {
  public:
    using Field = std::pair<std::string, std::string>;

    Headers() = default;
    Headers(std::initializer_list<Field> fields) : m_fields(fields) {}

    /// The value of the first field of that name, or null.
    [[nodiscard]] const std::string* find(std::string_view name) const;
    /// The value of the first field of that name, or an empty text.
    [[nodiscard]] std::string_view get(std::string_view name) const;
    /// Adds a field beside others of its name, as Set-Cookie needs it.
    void add(std::string name, std::string value);
    /// Gives a field this value, in place of all others of its name.
    void set(std::string name, std::string value);

    [[nodiscard]] auto begin() const { return m_fields.begin(); }
    [[nodiscard]] auto end() const { return m_fields.end(); }

  private:
    std::vector<Field> m_fields;
};

/// Whether two texts of ASCII are equal but for the case of their letters.
bool equal_without_case(std::string_view a, std::string_view b);

/// Whether the name is an RFC 9110 token and the value free of control characters but the tab: what may be
/// sent.
bool is_sendable(std::string_view name, std::string_view value);

using Parameters = std::vector<std::pair<std::string, std::string>>;

/// What a client asked for, checked and taken apart. `path` and parameters are percent-decoded UTF-8 without
/// control characters.
struct Request {
    std::string method;   ///< `GET`; HEAD reaches the handler of GET as `HEAD`
    std::string path;     ///< `/api/v1/designs/shoe`
    Parameters places;    ///< what stood for the {names} of the route's pattern
    Parameters query;     ///< in the order of the target; names may repeat
    Headers headers;      ///< of the head alone: trailers are dropped
    std::string body;     ///< at most the route's limit
    std::string peer;     ///< address of the other side, without port; `local` over a Unix socket
    bool secure = false;  ///< came over TLS
    bool local = false;   ///< came over the Unix socket
    std::optional<std::uint32_t> uid;  ///< of the process that connected over it, where the system tells

    /// What stood for {name} in the route's pattern. The name must be one of the pattern.
    [[nodiscard]] const std::string& place(std::string_view name) const;
    /// The value of a cookie; nothing if it is missing, or given twice with different values.
    [[nodiscard]] std::optional<std::string> cookie(std::string_view name) const;
};

/// An answer. The server adds length, date and security headers; a header that the handler gives stays as it
/// is.
struct Response {
    int status = 200;
    Headers headers;
    Bytes body;
};

/// An answer of the given type, such as `text/plain; charset=utf-8`.
Response answer(int status, std::string content_type, Bytes body);

/// A JSON answer. Text that is no UTF-8 appears with replacement characters.
Response json_answer(int status, const Json& value);

/// The HTTP status that an Error means: bad_input and usage 400, invalid 422, refused 403, system 500.
int status_of(ErrorCode code);

/// `{"error": {"kind", "where", "message"}}` with the status of its code. Of a system fault the client learns
/// only that there was one; the log is told which.
Response error_answer(const Error& error);

/// The same with a status that only the caller knows: 401 without a login, 409 for a state that does not
/// allow it.
Response error_answer(const Error& error, int status);

/// An entity tag of a hash: `"<hash>"`.
std::string etag_of(std::string_view hash);

/// Whether the client holds what this entity tag stands for (If-None-Match, weak comparison), so that 304 is
/// answer enough.
bool holds_already(const Request& request, std::string_view etag);

/// How a cookie is kept: always HttpOnly, SameSite=Strict and Path=/; Secure over TLS.
struct CookieLife {
    bool secure = true;
    std::optional<int> seconds;  ///< none: until the browser closes; 0: forget it now
};

/// The value of a Set-Cookie header. Errors: a name that is no token, a value with anything but letters,
/// digits and
/// `-_.~+/=`.
Result<std::string> set_cookie(std::string_view name, std::string_view value, const CookieLife& life);

/// Whether a request that changes something comes from this service's own pages: Sec-Fetch-Site and Origin,
/// where a browser sends them, must be those of the Host header. A program, which sends neither, passes.
bool from_own_pages(const Request& request);

/// The reason phrase of a status, such as `Not Found`; `Unknown` for others.
std::string_view reason_of(int status);

}  // namespace weave::net
