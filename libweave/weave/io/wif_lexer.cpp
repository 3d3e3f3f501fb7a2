#include <weave/io/wif_lexer.hpp>

#include <weave/core/text.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace weave::wif {

namespace {

constexpr std::size_t most_warnings = 200;

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\x1a';  // 1a: how DOS ended a file
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

Status open_section(File& file, std::string_view line, std::size_t number, std::size_t offset,
                    std::size_t& open) {
    const std::size_t close = line.find(']');
    if (close == std::string_view::npos)
        return bad_input(in_quotes(line) + " opens a section but has no ']'", place(number));
    std::string name = normal(line.substr(1, close - 1));
    if (name.empty() || name.size() > 200) return bad_input("is no name of a section", place(number));
    const auto [entry, is_new] = file.index.try_emplace(name, file.sections.size());
    open = entry->second;
    if (!is_new) {
        file.sections[open].repeated.push_back(number);
        return {};
    }
    if (file.sections.size() == most_sections)
        return bad_input("is the start of more than " + std::to_string(most_sections) + " sections",
                         place(number));
    file.sections.push_back({std::move(name), number, offset, {}, {}});
    return {};
}

Entry entry_of(std::string_view line, std::size_t number) {
    const std::size_t equals = line.find('=');
    const auto where = static_cast<std::uint32_t>(number);
    if (equals == std::string_view::npos) return {line, {}, where, false};
    return {trimmed(line.substr(0, equals)), trimmed(line.substr(equals + 1)), where, true};
}

}  // namespace

const Entry* Section::find(std::string_view key) const {
    const auto found = std::find_if(entries.begin(), entries.end(), [&](const Entry& entry) {
        return entry.key.size() >= key.size() && entry.key.size() < 200 && normal(entry.key) == key;
    });
    return found == entries.end() ? nullptr : &*found;
}

const Section* File::find(std::string_view name) const {
    const auto found = index.find(name);
    return found == index.end() ? nullptr : &sections[found->second];
}

Result<File> split(std::string_view text) {
    const std::string_view start = text.substr(0, 2);
    if (start == "\xff\xfe" || start == "\xfe\xff" ||
        text.substr(0, 4096).find('\0') != std::string_view::npos)
        return bad_input("is not plain text; a file saved as Unicode (UTF-16) must be saved as text",
                         place(1));
    File file;
    std::size_t open = 0, number = 0, lines = 0;
    for (std::size_t at = start == "\xef\xbb" && text.substr(2, 1) == "\xbf" ? 3 : 0; at < text.size();) {
        const std::size_t begin = at, end = std::min(text.find_first_of("\r\n", at), text.size());
        const std::string_view line = trimmed(text.substr(at, end - at));
        at = end + (text.substr(end, 2) == "\r\n" ? 2 : 1);
        ++number;
        if (line.empty() || line.front() == ';') continue;
        if (++lines > most_lines)
            return bad_input("is more than the limit of " + std::to_string(most_lines) + " lines",
                             place(number));
        if (line.front() == '[') {
            WEAVE_CHECK_OK(open_section(file, line, number, begin, open));
        } else if (file.sections.empty()) {
            return bad_input(in_quotes(line) + " stands before the first section, so this is no WIF file",
                             place(number));
        } else {
            file.sections[open].entries.push_back(entry_of(line, number));
        }
    }
    return file;
}

void Warnings::add(std::size_t line, const std::string& message) {
    add(place(line) + ": " + message);
}

void Warnings::add(const std::string& message) {
    if (m_texts.size() < most_warnings) {
        m_texts.push_back(message);
    } else {
        ++m_left_out;
    }
}

std::vector<std::string> Warnings::take() && {
    if (m_left_out > 0) m_texts.push_back("and " + counted(m_left_out, "more warning"));
    return std::move(m_texts);
}

std::string place(std::size_t line) {
    return "line " + std::to_string(line);
}

std::string normal(std::string_view name) {
    std::string result;
    for (const char c : trimmed(name)) {
        if (!is_blank(c)) {
            result.push_back(lower(c));
        } else if (result.back() != ' ') {
            result.push_back(' ');
        }
    }
    return result;
}

std::string shown(std::string_view section) {
    std::string text = utf8(section.substr(0, 60));
    for (char& c : text) {
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    }
    return "[" + text + "]";
}

std::string in_quotes(std::string_view words) {
    std::string text = utf8(words.substr(0, 40));
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
    }
    return "'" + text + (words.size() > 40 ? "...'" : "'");
}

std::string_view plain(std::string_view value) {
    return trimmed(value.substr(0, value.find(';')));
}

std::string utf8(std::string_view value) {
    if (is_utf8(value)) return std::string(value);
    std::string text;
    for (const char c : value) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x80) text.push_back(static_cast<char>(0xc0 | byte >> 6));
        text.push_back(byte < 0x80 ? c : static_cast<char>(0x80 | (byte & 0x3f)));
    }
    return text;
}

Result<bool> boolean(const Entry& entry) {
    const std::string word = normal(plain(entry.value));
    for (const char* yes : {"true", "on", "yes", "1"}) {
        if (word == yes) return true;
    }
    for (const char* no : {"false", "off", "no", "0"}) {
        if (word == no) return false;
    }
    return bad_input(in_quotes(entry.value) + " is neither true nor false", place(entry.line));
}

Result<std::int64_t> whole(const Entry& entry, std::int64_t low, std::int64_t high) {
    std::string_view text = plain(entry.value);
    const std::size_t point = text.find('.');
    if (point != std::string_view::npos && text.find_first_not_of('0', point + 1) == std::string_view::npos)
        text = text.substr(0, point);
    const std::optional<std::int64_t> number = parse_whole(text);
    if (!number) return bad_input(in_quotes(entry.value) + " is not a whole number", place(entry.line));
    if (*number < low || *number > high) {
        return bad_input(in_quotes(entry.key) + " must be from " + std::to_string(low) + " to " +
                             std::to_string(high) + ", not " + std::to_string(*number),
                         place(entry.line));
    }
    return *number;
}

Result<double> decimal(const Entry& entry) {
    const std::string_view text = plain(entry.value);
    double value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code == std::errc{} && end == text.data() + text.size() && std::isfinite(value)) return value;
    return bad_input(in_quotes(entry.value) + " is not a number", place(entry.line));
}

Result<std::vector<std::uint32_t>> whole_list(std::string_view value, std::size_t line, std::uint32_t high) {
    std::vector<std::uint32_t> list;
    for (std::string_view rest = plain(value); !rest.empty();) {
        const std::size_t comma = std::min(rest.find(','), rest.size());
        const std::string_view word = trimmed(rest.substr(0, comma));
        rest.remove_prefix(std::min(comma + 1, rest.size()));
        if (word.empty()) continue;
        const std::optional<std::int64_t> number = parse_whole(word);
        if (!number || *number < 0)
            return bad_input(in_quotes(word) + " is not a number from 0 up", place(line));
        if (*number > high) {
            return bad_input(
                "names number " + std::to_string(*number) + ", but the highest is " + std::to_string(high),
                place(line));
        }
        list.push_back(static_cast<std::uint32_t>(*number));
    }
    return list;
}

Result<std::vector<std::pair<std::size_t, Entry>>> numbered(const Section& section, Warnings& warnings) {
    std::vector<std::pair<std::size_t, Entry>> lines;
    lines.reserve(section.entries.size());
    for (const Entry& entry : section.entries) {
        const std::optional<std::int64_t> number = parse_whole(entry.key);
        if (!entry.assigns || !number || *number < 0) {
            return bad_input(
                in_quotes(entry.key) + " in " + shown(section.name) + " is not a number and its value",
                place(entry.line));
        }
        lines.emplace_back(static_cast<std::size_t>(*number), entry);
    }
    std::stable_sort(lines.begin(), lines.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t k = 1; k < lines.size(); ++k) {
        if (lines[k].first != lines[k - 1].first) continue;
        const Entry &earlier = lines[k - 1].second, &later = lines[k].second;
        const std::string again = "gives number " + std::to_string(lines[k].first) + " again, after line " +
                                  std::to_string(earlier.line);
        if (plain(earlier.value) != plain(later.value))
            return bad_input(again + ", with another value", place(later.line));
        warnings.add(later.line, again);
    }
    const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };
    lines.erase(std::unique(lines.begin(), lines.end(), same), lines.end());
    return lines;
}

}  // namespace weave::wif
