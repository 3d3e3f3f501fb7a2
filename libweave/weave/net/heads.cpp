#include <weave/net/heads.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <ctime>

namespace weave::net {

namespace {

bool all_digits(std::string_view text) {
    return !text.empty() && text.size() <= 18 &&
           std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

Status check_request_line(std::string_view line) {
    const std::size_t first = line.find(' ');
    const std::size_t second = first == std::string_view::npos ? first : line.find(' ', first + 1);
    if (second == std::string_view::npos) return bad_input("the request line is no METHOD TARGET VERSION");
    const std::string_view target = line.substr(first + 1, second - first - 1);
    if (!std::all_of(target.begin(), target.end(), [](char c) { return c > 0x20 && c < 0x7f; }))
        return bad_input("the target has a character that must be encoded");
    const std::string_view version = line.substr(second + 1);
    if (!is_sendable(line.substr(0, first), {}) || second == first + 1 || version.size() != 8 ||
        !version.starts_with("HTTP/1.") || !all_digits(version.substr(7)))
        return bad_input("the request line is no METHOD TARGET VERSION");
    return {};
}

Status check_field_line(std::string_view line) {
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos || !is_sendable(line.substr(0, colon), line.substr(colon + 1)))
        return bad_input("a header field is malformed");
    return {};
}

std::size_t count_of(const Headers& headers, std::string_view name) {
    return static_cast<std::size_t>(std::count_if(
        headers.begin(), headers.end(), [&](const auto& f) { return equal_without_case(f.first, name); }));
}

bool is_host_character(char c) {
    constexpr std::string_view marks = "-._";
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || marks.find(c) != std::string_view::npos;
}

bool is_bracketed_address(std::string_view host) {
    constexpr std::string_view marks = "0123456789abcdef:.";
    return host.size() > 2 && host.front() == '[' && host.back() == ']' &&
           host.substr(1, host.size() - 2).find_first_not_of(marks) == std::string_view::npos;
}

struct Default {
    const char* name;
    const char* value;
};
constexpr std::array<Default, 4> security_fields{{
    {"Content-Security-Policy",
     "default-src 'none'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cache-Control", "no-store"},
}};

}  // namespace

Status check_head(std::string_view head) {
    bool first = true;
    while (true) {
        const std::size_t end = head.find("\r\n");
        if (end == std::string_view::npos) return bad_input("the head is cut off");
        const std::string_view line = head.substr(0, end);
        head.remove_prefix(end + 2);
        if (line.empty() && !first) break;
        WEAVE_CHECK_OK(first ? check_request_line(line) : check_field_line(line));
        first = false;
    }
    if (!head.empty()) return bad_input("the head goes on after its end");
    return {};
}

Result<Framing> framing_of(const Headers& headers, bool version_1_0) {
    const std::string* const length = headers.find("Content-Length");
    const std::string* const coding = headers.find("Transfer-Encoding");
    if (count_of(headers, "Content-Length") + count_of(headers, "Transfer-Encoding") > 1)
        return bad_input("the length of the body is told more than once");
    Framing framing;
    if (coding != nullptr) {
        if (version_1_0 || !equal_without_case(*coding, "chunked"))
            return bad_input("the body comes in an unknown coding", "Transfer-Encoding");
        framing.chunked = true;
    } else if (length != nullptr) {
        if (!all_digits(*length)) return bad_input("is no length", "Content-Length");
        std::from_chars(length->data(), length->data() + length->size(), framing.length);
    }
    return framing;
}

Result<std::string> host_of(const Headers& headers, bool version_1_0) {
    const std::size_t count = count_of(headers, "Host");
    if (count == 0 && version_1_0) return std::string();
    if (count != 1) return bad_input("there must be one Host", "Host");
    std::string host(headers.get("Host"));
    const std::size_t colon = host.find_last_of(":]");
    if (colon != std::string::npos && host[colon] == ':') {
        const std::string_view port = std::string_view(host).substr(colon + 1);
        if (!all_digits(port) || port.size() > 5) return bad_input("is no host with a port", "Host");
        host.resize(colon);
    }
    std::transform(host.begin(), host.end(), host.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    const bool named = !host.empty() && std::all_of(host.begin(), host.end(), is_host_character);
    if (!named && !is_bracketed_address(host)) return bad_input("is no host", "Host");
    return host;
}

std::string http_date(std::int64_t seconds_since_1970) {
    static constexpr const char* days[] = {"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
    static constexpr const char* months[] = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                             "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
    const std::time_t time = seconds_since_1970;
    std::tm parts{};
    ::gmtime_r(&time, &parts);
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%s, %02d %s %04d %02d:%02d:%02d GMT", days[parts.tm_wday],
                  parts.tm_mday, months[parts.tm_mon], parts.tm_year + 1900, parts.tm_hour, parts.tm_min,
                  parts.tm_sec);
    return text.data();
}

Response sendable(Response response) {
    for (const auto& [name, value] : response.headers)
        if (!is_sendable(name, value))
            return error_answer(system_fault("a header field cannot be sent", name));
    return response;
}

std::string written_head(const Response& response, const HeadContext& context) {
    const auto field = [](std::string_view name, std::string_view value) {
        return std::string(name) + ": " + std::string(value) + "\r\n";
    };
    std::string head = "HTTP/1.1 " + std::to_string(response.status) + " " +
                       std::string(reason_of(response.status)) + "\r\n";
    for (const auto& [name, value] : response.headers) {
        const bool own = equal_without_case(name, "Content-Length") ||
                         equal_without_case(name, "Connection") ||
                         equal_without_case(name, "Transfer-Encoding") || equal_without_case(name, "Date");
        if (!own) head += field(name, value);
    }
    for (const Default& standard : security_fields)
        if (response.headers.find(standard.name) == nullptr) head += field(standard.name, standard.value);
    if (context.secure && response.headers.find("Strict-Transport-Security") == nullptr)
        head += field("Strict-Transport-Security", "max-age=31536000");
    head += field("Date", context.date);
    if (response.status != 204 && response.status != 304)
        head += field("Content-Length", std::to_string(response.body ? response.body->size() : 0));
    if (!context.keep_alive) head += field("Connection", "close");
    return head + "\r\n";
}

}  // namespace weave::net
