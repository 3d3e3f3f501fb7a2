#include <weave/net/message.hpp>

#include <weave/core/log.hpp>
#include <weave/core/text.hpp>

#include <algorithm>
#include <array>
#include <cassert>

namespace weave::net {

namespace {

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool is_alphanumeric(char c) {
    return (lower(c) >= 'a' && lower(c) <= 'z') || (c >= '0' && c <= '9');
}

bool is_token(std::string_view text) {
    constexpr std::string_view marks = "!#$%&'*+-.^_`|~";
    return !text.empty() && std::all_of(text.begin(), text.end(), [&](char c) {
        return is_alphanumeric(c) || marks.find(c) != std::string_view::npos;
    });
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    return text;
}

/// Calls `use` with each part of a list.
template <class Use>
void for_each_part(std::string_view list, char separator, Use use) {
    while (!list.empty()) {
        const std::size_t end = std::min(list.find(separator), list.size());
        use(trimmed(list.substr(0, end)));
        list.remove_prefix(std::min(end + 1, list.size()));
    }
}

}  // namespace

Bytes make_bytes(std::string text) {
    return std::make_shared<const std::string>(std::move(text));
}

bool equal_without_case(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](char x, char y) { return lower(x) == lower(y); });
}

bool is_sendable(std::string_view name, std::string_view value) {
    return is_token(name) && std::none_of(value.begin(), value.end(), [](char c) {
               const auto byte = static_cast<unsigned char>(c);
               return (byte < 0x20 && c != '\t') || byte == 0x7f;
           });
}

const std::string* Headers::find(std::string_view name) const {
    const auto found = std::find_if(m_fields.begin(), m_fields.end(), [&](const Field& field) {
        return equal_without_case(field.first, name);
    });
    return found == m_fields.end() ? nullptr : &found->second;
}

std::string_view Headers::get(std::string_view name) const {
    const std::string* const value = find(name);
    return value == nullptr ? std::string_view{} : *value;
}

void Headers::add(std::string name, std::string value) {
    m_fields.emplace_back(std::move(name), std::move(value));
}

void Headers::set(std::string name, std::string value) {
    std::erase_if(m_fields, [&](const Field& field) { return equal_without_case(field.first, name); });
    add(std::move(name), std::move(value));
}

const std::string& Request::place(std::string_view name) const {
    const auto found =
        std::find_if(places.begin(), places.end(), [&](const auto& p) { return p.first == name; });
    assert(found != places.end());
    return found->second;
}

std::optional<std::string> Request::cookie(std::string_view name) const {
    std::optional<std::string> found;
    bool contradicted = false;
    for (const auto& [header, list] : headers) {
        if (!equal_without_case(header, "Cookie")) continue;
        for_each_part(list, ';', [&](std::string_view pair) {
            const std::size_t equals = pair.find('=');
            if (equals == std::string_view::npos || pair.substr(0, equals) != name) return;
            const std::string value(pair.substr(equals + 1));
            contradicted |= found && *found != value;  // planted beside the true one by a neighbouring site
            found = value;
        });
    }
    return contradicted ? std::nullopt : found;
}

Response answer(int status, std::string content_type, Bytes body) {
    Response response{status, {}, std::move(body)};
    response.headers.add("Content-Type", std::move(content_type));
    return response;
}

Response json_answer(int status, const Json& value) {
    return answer(status, "application/json",
                  make_bytes(value.dump(-1, ' ', false, Json::error_handler_t::replace)));
}

int status_of(ErrorCode code) {
    switch (code) {
        case ErrorCode::usage:
        case ErrorCode::bad_input:
            return 400;
        case ErrorCode::invalid:
            return 422;
        case ErrorCode::refused:
            return 403;
        case ErrorCode::system:
            break;
    }
    return 500;
}

Response error_answer(const Error& error) {
    return error_answer(error, status_of(error.code));
}

Response error_answer(const Error& error, int status) {
    const bool ours = error.code == ErrorCode::system && status == 500;
    if (ours) log(LogLevel::warning, "a request failed: " + on_one_line(error.text()));
    return json_answer(
        status, {{"error",
                  {{"kind", kind_of(error.code)},
                   {"where", ours ? std::string() : error.where},
                   {"message", ours ? "a fault of the service; its log says which" : error.message}}}});
}

std::string etag_of(std::string_view hash) {
    return '"' + std::string(hash) + '"';
}

bool holds_already(const Request& request, std::string_view etag) {
    bool held = false;
    const auto without_weak = [](std::string_view tag) {
        return tag.starts_with("W/") ? tag.substr(2) : tag;
    };
    for (const auto& [name, list] : request.headers) {
        if (!equal_without_case(name, "If-None-Match")) continue;
        for_each_part(list, ',', [&](std::string_view tag) {
            held |= tag == "*" || without_weak(tag) == without_weak(etag);
        });
    }
    return held && !etag.empty();
}

Result<std::string> set_cookie(std::string_view name, std::string_view value, const CookieLife& life) {
    constexpr std::string_view marks = "-_.~+/=";
    const bool plain = std::all_of(value.begin(), value.end(), [&](char c) {
        return is_alphanumeric(c) || marks.find(c) != std::string_view::npos;
    });
    if (!is_token(name) || !plain) return Error{ErrorCode::usage, "is no cookie", on_one_line(name)};
    std::string text = std::string(name) + "=" + std::string(value) + "; Path=/; HttpOnly; SameSite=Strict";
    if (life.secure) text += "; Secure";
    if (life.seconds) text += "; Max-Age=" + std::to_string(*life.seconds);
    return text;
}

bool from_own_pages(const Request& request) {
    const std::string_view site = request.headers.get("Sec-Fetch-Site");
    if (!site.empty() && site != "same-origin" && site != "none") return false;
    const std::string* const origin = request.headers.find("Origin");
    if (origin == nullptr) return true;
    const std::string own =
        (request.secure ? "https://" : "http://") + std::string(request.headers.get("Host"));
    return equal_without_case(*origin, own);
}

std::string_view reason_of(int status) {
    struct Reason {
        int status;
        std::string_view phrase;
    };
    static constexpr auto reasons = std::to_array<Reason>({
        {100, "Continue"},
        {101, "Switching Protocols"},
        {200, "OK"},
        {201, "Created"},
        {202, "Accepted"},
        {204, "No Content"},
        {206, "Partial Content"},
        {302, "Found"},
        {303, "See Other"},
        {304, "Not Modified"},
        {400, "Bad Request"},
        {401, "Unauthorized"},
        {403, "Forbidden"},
        {404, "Not Found"},
        {405, "Method Not Allowed"},
        {408, "Request Timeout"},
        {409, "Conflict"},
        {410, "Gone"},
        {412, "Precondition Failed"},
        {413, "Content Too Large"},
        {415, "Unsupported Media Type"},
        {417, "Expectation Failed"},
        {421, "Misdirected Request"},
        {422, "Unprocessable Content"},
        {426, "Upgrade Required"},
        {428, "Precondition Required"},
        {429, "Too Many Requests"},
        {431, "Request Header Fields Too Large"},
        {500, "Internal Server Error"},
        {501, "Not Implemented"},
        {503, "Service Unavailable"},
        {504, "Gateway Timeout"},
        {505, "HTTP Version Not Supported"},
        {507, "Insufficient Storage"},
    });
    const auto* const found =
        std::find_if(reasons.begin(), reasons.end(), [&](const Reason& r) { return r.status == status; });
    return found == reasons.end() ? "Unknown" : found->phrase;
}

}  // namespace weave::net
