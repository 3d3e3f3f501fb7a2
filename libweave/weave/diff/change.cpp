#include <weave/diff/change.hpp>

#include <weave/core/text.hpp>

#include <algorithm>

namespace weave {

namespace {

std::string ordinal(std::size_t number) {
    const std::size_t tens = number % 100, ones = number % 10;
    const char* const ending = tens >= 11 && tens <= 13 ? "th"
                               : ones == 1              ? "st"
                               : ones == 2              ? "nd"
                               : ones == 3              ? "rd"
                                                        : "th";
    return std::to_string(number) + ending;
}

std::string range_in_words(const LineRange& range) {
    const std::string first = std::to_string(range.first + 1), last = std::to_string(range.last + 1);
    if (range.first == range.last) return first;
    if (range.step == 1) return first + (range.last == range.first + 1 ? ", " : " to ") + last;
    if (range.last == range.first + range.step) return first + ", " + last;
    return first + " to " + last + ", every " + ordinal(range.step);
}

/// A text of an answer is not longer, in bytes: an order may be written in millions of words.
constexpr std::size_t longest_text = 4096;

Json cut(const Json& value) {
    if (!value.is_string() || value.get_ref<const std::string&>().size() <= longest_text) return value;
    const std::string text = in_quotes(value.get_ref<const std::string&>(), longest_text);
    return text.substr(1, text.size() - 2);
}

}  // namespace

const std::string& name_of(ChangeKind kind) {
    static const std::string names[]{"added", "removed", "changed", "renamed", "moved"};
    return names[static_cast<std::size_t>(kind)];
}

std::string in_quotes(std::string_view text, std::size_t most_bytes) {
    std::size_t kept = 0;
    while (kept < text.size()) {
        const std::size_t length = std::max<std::size_t>(utf8_length(text.substr(kept)), 1);
        if (kept + length > most_bytes) break;
        kept += length;
    }
    return "'" + on_one_line(text.substr(0, kept)) + (kept < text.size() ? " ...'" : "'");
}

std::string shown(const Json& value) {
    if (value.is_null()) return "not set";
    if (value.is_string()) return in_quotes(value.get_ref<const std::string&>());
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    if (value.is_number_float()) return ecmascript_number(value.get<double>());
    const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (value.is_structured()) return in_quotes(text, 100);
    return text;
}

std::string was_and_is(const Json& before, const Json& after, const std::string& unit) {
    const auto with_unit = [&](const Json& value) {
        return shown(value) + (value.is_number() && !unit.empty() ? " " + unit : "");
    };
    if (before.is_null()) return "is " + with_unit(after) + ", was not set";
    if (after.is_null()) return "is not set, was " + with_unit(before);
    return "is " + with_unit(after) + ", was " + with_unit(before);
}

std::string lines_in_words(const std::string& noun, const std::vector<LineRange>& lines) {
    constexpr std::size_t most = 6;
    if (lines.empty()) return "no " + noun;
    const bool one = lines.size() == 1 && lines[0].first == lines[0].last;
    std::string text = noun + (one ? " " : "s ");
    for (std::size_t k = 0; k < std::min(most, lines.size()); ++k)
        text += (k > 0 ? "; " : "") + range_in_words(lines[k]);
    if (lines.size() > most) text += "; and " + std::to_string(lines.size() - most) + " more ranges";
    return text;
}

std::vector<LineRange> ranges_of(const std::vector<std::size_t>& lines) {
    std::vector<LineRange> ranges;
    for (std::size_t k = 0; k < lines.size();) {
        LineRange range{lines[k], lines[k], 1};
        std::size_t next = k + 1;
        if (next < lines.size()) range.step = lines[next] - lines[k];
        while (next < lines.size() && lines[next] == range.last + range.step) range.last = lines[next++];
        // Two lines far apart are no rhythm: the second may begin one.
        if (next == k + 2 && range.step > 1) {
            range = {lines[k], lines[k], 1};
            next = k + 1;
        }
        if (range.first == range.last) range.step = 1;
        ranges.push_back(range);
        k = next;
    }
    return ranges;
}

Json to_json(const std::vector<LineRange>& lines) {
    Json list = Json::array();
    for (const LineRange& range : lines) {
        if (list.size() == most_listed) break;
        list.push_back({{"first", range.first + 1}, {"last", range.last + 1}, {"step", range.step}});
    }
    return list;
}

Json to_json(const Change& change) {
    Json json{{"kind", name_of(change.kind)}, {"where", change.where}, {"text", change.text}};
    json["before"] = cut(change.before);
    json["after"] = cut(change.after);
    if (change.count > 0) json["count"] = change.count;
    if (!change.lines.empty()) {
        json["lines"] = to_json(change.lines);
        json["ranges"] = change.lines.size();
    }
    return json;
}

Json to_json(const Changes& changes) {
    Json list = Json::array();
    for (const Change& change : changes) {
        if (list.size() == most_listed) break;
        list.push_back(to_json(change));
    }
    return list;
}

}  // namespace weave
