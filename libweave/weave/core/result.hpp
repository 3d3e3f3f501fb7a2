#pragma once

#include <cassert>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace weave {

/// What kind of trouble an Error is; programs turn it into their exit code.
enum class ErrorCode {
    usage,      ///< the call itself makes no sense (exit 2)
    bad_input,  ///< a file or value from outside cannot be understood (exit 3)
    invalid,    ///< understood, but the weave does not allow it, such as a flip that is blocked (exit 1)
    refused,    ///< not permitted in this state or to this person (exit 4)
    system,     ///< disk, network or device failed (exit 5)
};

/// The kind as programs and services write it, `kind` in their JSON.
inline const char* kind_of(ErrorCode code) {
    switch (code) {
        case ErrorCode::usage:
            return "usage";
        case ErrorCode::bad_input:
            return "bad input";
        case ErrorCode::invalid:
            return "invalid";
        case ErrorCode::refused:
            return "refused";
        case ErrorCode::system:
            break;
    }
    return "system";
}

/// A failure that a user can cause and must be able to understand.
struct Error {
    ErrorCode code = ErrorCode::bad_input;
    std::string message;  ///< a sentence without a full stop, in weavers' words
    std::string where;    ///< file and place, such as `shoe.weave: blocks.toe.stacks[3][4]`; may be empty

    /// The same error seen from a file: its name goes in front of the place, `shoe.weave: blocks.toe`.
    [[nodiscard]] Error in(const std::string& file) && {
        where = where.empty() ? file : file + ": " + where;
        return std::move(*this);
    }

    /// The same error seen from further out in a document: `blocks.toe` and `stacks[3][4]` make
    /// `blocks.toe.stacks[3][4]`.
    [[nodiscard]] Error under(const std::string& path) && {
        where = where.empty() || where.front() == '[' ? path + where : path + "." + where;
        return std::move(*this);
    }

    /// One line for a person: place first, then cause.
    [[nodiscard]] std::string text() const { return where.empty() ? message : where + ": " + message; }
};

inline Error bad_input(std::string message, std::string where = {}) {
    return {ErrorCode::bad_input, std::move(message), std::move(where)};
}
inline Error invalid(std::string message, std::string where = {}) {
    return {ErrorCode::invalid, std::move(message), std::move(where)};
}
inline Error system_fault(std::string message, std::string where = {}) {
    return {ErrorCode::system, std::move(message), std::move(where)};
}

/// A value, or the Error that kept it from being made.
template <class T>
class [[nodiscard]] Result {
  public:
    using Value = T;
    Result(T value) : m_content(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : m_content(std::in_place_index<1>, std::move(error)) {}

    explicit operator bool() const { return m_content.index() == 0; }

    T& value() & { return assert(*this), *std::get_if<0>(&m_content); }
    const T& value() const& { return assert(*this), *std::get_if<0>(&m_content); }
    T&& value() && { return assert(*this), std::move(*std::get_if<0>(&m_content)); }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T&& operator*() && { return std::move(*this).value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

    const Error& error() const& { return assert(!*this), *std::get_if<1>(&m_content); }
    Error&& error() && { return assert(!*this), std::move(*std::get_if<1>(&m_content)); }

  private:
    std::variant<T, Error> m_content;
};

/// Success without a value, or an Error.
class [[nodiscard]] Status {
  public:
    Status() = default;
    Status(Error error) : m_error(std::move(error)) {}
    explicit operator bool() const { return !m_error; }
    const Error& error() const& { return *m_error; }
    Error&& error() && { return std::move(*m_error); }

  private:
    std::optional<Error> m_error;
};

}  // namespace weave

#define WEAVE_JOIN2(a, b) a##b
#define WEAVE_JOIN(a, b) WEAVE_JOIN2(a, b)

/// `WEAVE_TRY(auto x, make_x());` declares x, or returns the error of make_x() from the enclosing function.
#define WEAVE_TRY(declaration, ...)                                                                    \
    auto WEAVE_JOIN(weave_try_, __LINE__) = (__VA_ARGS__);                                             \
    if (!WEAVE_JOIN(weave_try_, __LINE__)) return std::move(WEAVE_JOIN(weave_try_, __LINE__)).error(); \
    declaration = std::move(WEAVE_JOIN(weave_try_, __LINE__)).value()

/// `WEAVE_CHECK_OK(check());` returns the error of a Status (or Result) from the enclosing function.
#define WEAVE_CHECK_OK(...) \
    if (auto weave_status = (__VA_ARGS__); !weave_status) return std::move(weave_status).error()
