#include <loomlink/workflow/names.hpp>

#include <weave/core/text.hpp>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace weave::loomlink {

namespace {

constexpr std::size_t most_name = 64;

/// From and to: what is drawn as nothing, or as a blank that is no space. Bytes of UTF-8 sort as the
/// characters do.
using Span = std::pair<std::string_view, std::string_view>;
constexpr std::array<Span, 15> unseen{{{"\u00ad", "\u00ad"},
                                       {"\u034f", "\u034f"},
                                       {"\u115f", "\u1160"},
                                       {"\u17b4", "\u17b5"},
                                       {"\u180b", "\u180f"},
                                       {"\u200b", "\u200f"},
                                       {"\u2060", "\u206f"},
                                       {"\u2800", "\u2800"},
                                       {"\u3164", "\u3164"},
                                       {"\ufe00", "\ufe0f"},
                                       {"\ufeff", "\ufeff"},
                                       {"\uffa0", "\uffa0"},
                                       {"\ufff9", "\ufffb"},
                                       {"\U0001bca0", "\U0001bca3"},
                                       {"\U0001d173", "\U0001d17a"}}};
constexpr Span unseen_plane{"\U000e0000", "\U000e0fff"};  // tags and variants

bool lies_in(std::string_view character, const Span& span) {
    return character >= span.first && character <= span.second;
}

bool is_unseen(std::string_view character) {
    return lies_in(character, unseen_plane) ||
           std::any_of(unseen.begin(), unseen.end(),
                       [&](const Span& span) { return lies_in(character, span); });
}

/// Blanks that look like the usual one and are another: no-break, of other widths, of other scripts.
constexpr std::string_view odd_blanks[]{"\u00a0", "\u1680", "\u2000", "\u2001", "\u2002", "\u2003", "\u2004", "\u2005",
                                        "\u2006", "\u2007", "\u2008", "\u2009", "\u200a", "\u202f", "\u205f", "\u3000"};

bool is_odd_blank(std::string_view character) {
    return std::find(std::begin(odd_blanks), std::end(odd_blanks), character) != std::end(odd_blanks);
}

bool is_seen(std::string_view character) {
    const bool blank = character == " " || character == "\t" || character == "\n" || is_odd_blank(character);
    return !blank && !is_unseen(character);
}

/// Whether a character of `text`, which is UTF-8, is such a one.
template <class Is>
bool has(std::string_view text, Is is) {
    while (!text.empty()) {
        const std::size_t length = utf8_length(text);
        if (is(text.substr(0, length))) return true;
        text.remove_prefix(length);
    }
    return false;
}

bool is_plain(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
}

Status check_size(const std::string& text, const std::string& member, std::size_t least, std::size_t most) {
    if (!is_utf8(text)) return bad_input("is not UTF-8", member);
    if (text.size() < least) return bad_input("is missing", member);
    if (text.size() > most) return bad_input("is longer than " + std::to_string(most) + " bytes", member);
    return {};
}

/// Windows drops blanks before the point: `con .x` is the device as well.
bool is_device(std::string_view name) {
    std::string_view stem = name.substr(0, name.find('.'));
    while (stem.ends_with(' ')) stem.remove_suffix(1);
    return is_device_name(stem);
}

}  // namespace

Status check_text(const std::string& text, const std::string& member) {
    WEAVE_CHECK_OK(check_size(text, member, 0, most_text));
    std::string line = text;
    std::erase_if(line, [](char c) { return c == '\n' || c == '\t'; });
    if (on_one_line(line) != line)
        return bad_input("has control characters, or marks that turn the direction of writing", member);
    if (!has(text, is_seen)) return bad_input("says nothing: there is no character in it that one can see", member);
    return {};
}

Status check_line(const std::string& text, const std::string& member, std::size_t least, std::size_t most) {
    WEAVE_CHECK_OK(check_size(text, member, least, most));
    if (on_one_line(text) != text)
        return bad_input("has line breaks, control characters, or marks that turn the direction of writing",
                         member);
    if (has(text, is_unseen)) return bad_input("has characters that nobody sees", member);
    if (text.find_first_not_of(' ') == std::string::npos && least > 0) return bad_input("is missing", member);
    if (text.starts_with(' ') || text.ends_with(' ') || text.find("  ") != std::string::npos || has(text, is_odd_blank))
        return bad_input("has blanks in front, behind, twice, or that are none of a keyboard's", member);
    return {};
}

Status check_name(const std::string& name, const std::string& member, bool spaces) {
    const bool fits =
        !name.empty() && name.size() <= most_name && name.front() != ' ' && name.back() != ' ' &&
        name.find("  ") == std::string::npos &&
        std::all_of(name.begin(), name.end(), [&](char c) { return is_plain(c) || (spaces && c == ' '); });
    if (!fits)
        return bad_input(
            std::string("must be 1 to 64 of the letters a to z and A to Z, digits, '.', '-' and '_'") +
                (spaces ? ", with single spaces within" : ""),
            member);
    if (name.front() == '.' || name.front() == '-') return bad_input("may not start with '.' or '-'", member);
    if (name.back() == '.') return bad_input("may not end with '.'", member);
    if (is_device(name))
        return bad_input("is the name of a device on Windows, which takes no file of that name", member);
    return {};
}

}  // namespace weave::loomlink
