#include <loomlink/commands/words.hpp>

#include <weave/core/text.hpp>

#include <algorithm>

namespace weave::loomlink {

namespace {

std::string value_told(const Json& value) {
    if (value.is_null()) return "";
    if (value.is_string()) return on_one_line(value.get_ref<const std::string&>());
    if (!value.is_array()) return on_one_line(value.dump(-1, ' ', false, Json::error_handler_t::replace));
    std::string all;
    for (const Json& entry : value) all += (all.empty() ? "" : ", ") + value_told(entry);
    return all;
}

}  // namespace

std::string told(const Json& json, const std::string& member) {
    if (!json.is_object() || !json.contains(member)) return "";
    return value_told(json.at(member));
}

std::vector<Json> entries(const Json& json, const std::string& member) {
    if (!json.is_object() || !json.contains(member) || !json.at(member).is_array()) return {};
    return {json.at(member).begin(), json.at(member).end()};
}

std::string in_columns(const std::vector<std::vector<std::string>>& lines) {
    std::vector<std::size_t> widths;
    for (const auto& line : lines)
        for (std::size_t k = 0; k < line.size(); ++k) {
            if (k == widths.size()) widths.push_back(0);
            widths[k] = std::max(widths[k], on_one_line(line[k]).size());
        }
    std::string text;
    for (const auto& line : lines) {
        std::string row;
        for (std::size_t k = 0; k < line.size(); ++k) {
            std::string cell = on_one_line(line[k]);
            if (k + 1 < line.size()) cell.resize(widths[k] + 2, ' ');
            row += cell;
        }
        row.erase(row.find_last_not_of(' ') + 1);
        text += row + "\n";
    }
    return text;
}

std::string in_columns(const Json& json, const std::string& list, const std::vector<std::string>& members) {
    std::vector<std::vector<std::string>> lines;
    for (const Json& entry : entries(json, list)) {
        std::vector<std::string> line;
        for (const std::string& member : members) line.push_back(told(entry, member));
        lines.push_back(std::move(line));
    }
    return in_columns(lines);
}

std::string as_list(const std::string& lines) {
    return lines.empty() ? "none\n" : lines;
}

}  // namespace weave::loomlink
