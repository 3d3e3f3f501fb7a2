#include <weave/net/target.hpp>

#include <weave/core/text.hpp>

#include <algorithm>

namespace weave::net {

namespace {

constexpr std::size_t most_parameters = 64;

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

bool is_unreserved(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '.' || c == '_' || c == '~';
}

/// Whether RFC 3986 lets the character stand in a path or query as it is (`%` begins an encoded one).
bool may_stand(char c) {
    constexpr std::string_view marks = "!$&'()*+,;=:@%/?";
    return is_unreserved(c) || marks.find(c) != std::string_view::npos;
}

Status check_segment(std::string_view segment) {
    if (segment.empty() || segment == "." || segment == "..")
        return bad_input("the path has an empty or a dotted segment");
    if (segment.find_first_of("/\\") != std::string_view::npos) return bad_input("the path hides a slash");
    return {};
}

Result<std::string> decoded_path(std::string_view path) {
    if (path.empty() || path.front() != '/') return bad_input("the target does not start with a slash");
    std::string decoded;
    std::string_view rest = path.substr(1);
    if (rest.empty()) return std::string("/");
    for (bool more = true; more;) {
        const std::size_t slash = rest.find('/');
        more = slash != std::string_view::npos;
        WEAVE_TRY(const std::string segment, percent_decoded(rest.substr(0, slash)));
        WEAVE_CHECK_OK(check_segment(segment));
        decoded += '/' + segment;
        if (more) rest.remove_prefix(slash + 1);
    }
    return decoded;
}

}  // namespace

Result<std::string> percent_decoded(std::string_view text) {
    std::string decoded;
    decoded.reserve(text.size());
    for (std::size_t k = 0; k < text.size(); ++k) {
        char c = text[k];
        if (c == '%') {
            const int high = k + 2 < text.size() ? hex_digit(text[k + 1]) : -1;
            const int low = k + 2 < text.size() ? hex_digit(text[k + 2]) : -1;
            if (high < 0 || low < 0) return bad_input("a % is not followed by two hexadecimal digits");
            c = static_cast<char>(high * 16 + low);
            k += 2;
        }
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7f) return bad_input("a control character stands in the target");
        decoded += c;
    }
    if (!is_utf8(decoded)) return bad_input("the target is not UTF-8");
    return decoded;
}

std::string percent_encoded(std::string_view text) {
    constexpr std::string_view digits = "0123456789ABCDEF";
    std::string encoded;
    for (const char c : text) {
        if (is_unreserved(c)) {
            encoded += c;
            continue;
        }
        const auto byte = static_cast<unsigned char>(c);
        encoded += '%';
        encoded += digits[byte >> 4];
        encoded += digits[byte & 15];
    }
    return encoded;
}

Result<Parameters> parse_query(std::string_view query) {
    Parameters parameters;
    while (!query.empty()) {
        const std::size_t end = std::min(query.find('&'), query.size());
        std::string pair(query.substr(0, end));
        query.remove_prefix(std::min(end + 1, query.size()));
        if (pair.empty()) continue;
        if (parameters.size() == most_parameters) return bad_input("there are too many parameters");
        std::replace(pair.begin(), pair.end(), '+', ' ');
        const std::size_t equals = std::min(pair.find('='), pair.size());
        WEAVE_TRY(std::string name, percent_decoded(std::string_view(pair).substr(0, equals)));
        WEAVE_TRY(std::string value,
                  percent_decoded(std::string_view(pair).substr(std::min(equals + 1, pair.size()))));
        parameters.emplace_back(std::move(name), std::move(value));
    }
    return parameters;
}

Result<Target> parse_target(std::string_view target) {
    if (!std::all_of(target.begin(), target.end(), may_stand))
        return bad_input("the target has a character that must be encoded");
    const std::size_t mark = std::min(target.find('?'), target.size());
    Target parsed;
    WEAVE_TRY(parsed.path, decoded_path(target.substr(0, mark)));
    WEAVE_TRY(parsed.query, parse_query(target.substr(std::min(mark + 1, target.size()))));
    return parsed;
}

}  // namespace weave::net
