#include <simd/commands/status_table.hpp>

#include <weave/core/text.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <simd/daemon/room.hpp>
#include <simd/service/page.hpp>
#include <vector>

namespace weave::simd {

namespace {

struct Column {
    const char* title;
    std::size_t width;
    bool is_text;
    int spared;  ///< 0: never; else it is left out on narrow terminals, the highest first
};

constexpr std::array<Column, 11> columns_of_table{{{"", 4, true, 0},
                                                   {"STATE", 8, true, 0},
                                                   {"PERSON", 12, true, 0},
                                                   {"STEPS", 9, false, 0},
                                                   {"PER S", 7, false, 1},
                                                   {"RESIDUAL", 9, false, 3},
                                                   {"POINTS", 9, false, 5},
                                                   {"MEMORY", 9, false, 2},
                                                   {"COMPUTED", 11, false, 6},
                                                   {"LEFT", 11, false, 4},
                                                   {"TITLE", 12, true, 0}}};
constexpr std::size_t longest_title = 30;
using Row = std::array<std::string, columns_of_table.size()>;
using Widths = std::array<std::size_t, columns_of_table.size()>;  ///< 0: the column is left out

/// Columns that the character at the beginning takes at most: those of East Asia take two.
std::size_t columns_of(std::string_view text) {
    return static_cast<unsigned char>(text.front()) >= 0xe1 ? 2 : 1;
}

std::size_t width_of(std::string_view text) {
    std::size_t width = 0;
    for (; !text.empty(); text.remove_prefix(std::max<std::size_t>(1, utf8_length(text)))) width += columns_of(text);
    return width;
}

std::size_t sum_of(const Widths& widths) {
    std::size_t sum = 0;
    for (const std::size_t width : widths) sum += width > 0 ? width + 1 : 0;  // with a blank between
    return sum - 1;
}

/// The columns for a terminal so wide. The title has what is left.
Widths widths_for(std::size_t columns) {
    Widths widths{};
    int most = 0;
    for (std::size_t k = 0; k < widths.size(); ++k) {
        widths[k] = columns_of_table[k].width;
        most = std::max(most, columns_of_table[k].spared);
    }
    for (; most > 0 && sum_of(widths) > columns; --most) {
        for (std::size_t k = 0; k < widths.size(); ++k) {
            if (columns_of_table[k].spared == most) widths[k] = 0;
        }
    }
    const std::size_t left = columns - std::min(columns, sum_of(widths));
    widths.back() = std::min(longest_title, widths.back() + left);
    return widths;
}

std::string cell(std::string text, std::size_t width, bool is_text) {
    text = on_one_line(text);
    if (width_of(text) > width) text = clipped(text, width - 1) + "~";
    const std::string blanks(width - width_of(text), ' ');
    return (is_text ? text + blanks : blanks + text) + " ";
}

std::string row(const Row& texts, const Widths& widths, std::size_t columns) {
    std::string line;
    for (std::size_t k = 0; k < texts.size(); ++k) {
        if (widths[k] > 0) line += cell(texts[k], widths[k], columns_of_table[k].is_text);
    }
    line = clipped(line, columns);
    while (!line.empty() && line.back() == ' ') line.pop_back();
    return line + "\n";
}

std::string form(const char* how, double value) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), how, value);
    return text.data();
}

std::string residual(const Json& work) {
    const Json& value = work.at("residual");
    return value.is_null() || value.get<double>() <= 0 ? "-" : form("%.1e", value.get<double>());
}

Row texts_of(const Json& work) {
    const bool is_job = work.contains("job");
    const Json left = work.value("left_s", Json());
    return {(is_job ? "j" : "s") + std::to_string(work.at(is_job ? "job" : "session").get<std::uint64_t>()),
            phase_text(work),
            work.value("person", std::string("-")),
            std::to_string(work.at("step").get<std::uint64_t>()),
            form("%.0f", work.at("steps_per_second")),
            residual(work),
            std::to_string(work.at("points").get<std::uint64_t>()),
            memory_text(work.at("memory_bytes")),
            time_text(work.at("computed_s")),
            left.is_null() ? "-" : time_text(left),
            work.value("title", std::string("-"))};
}

}  // namespace

std::string clipped(std::string_view text, std::size_t columns) {
    std::size_t end = 0, width = 0;
    while (end < text.size()) {
        width += columns_of(text.substr(end));
        if (width > columns) break;
        end += std::max<std::size_t>(1, utf8_length(text.substr(end)));
    }
    return std::string(text.substr(0, end));
}

std::string status_table(const Json& status, std::size_t columns, std::size_t lines) {
    const Json& memory = status.at("memory");
    std::vector<std::string> told;
    const std::string who = "simd, up " + time_text(status.at("up_s")) + ": " + counted(status.at("sessions").size(), "session") + ", " + counted(status.at("jobs").size(), "job") +
                            ", " + counted(status.at("clients").get<std::size_t>(), "connection");
    const std::string what = memory_text(memory.at("promised_bytes")) + " of " + memory_text(memory.at("bytes")) + " promised; " +
                             counted(status.at("threads").get<std::size_t>(), "thread") + ", " + std::to_string(status.at("turns_waiting").get<std::size_t>()) + " waiting to compute";
    told.push_back(clipped(who, columns) + "\n");
    told.push_back(clipped(what, columns) + "\n");
    const Widths widths = widths_for(columns);
    Row titles;
    for (std::size_t k = 0; k < titles.size(); ++k) titles[k] = columns_of_table[k].title;
    told.push_back(row(titles, widths, columns));
    Json works = status.at("sessions");
    for (const Json& job : status.at("jobs")) works.push_back(job);
    const std::vector<Json> rows = busiest_first(works);
    const std::size_t room = lines - std::min(lines, told.size()), shown = rows.size() <= room ? rows.size() : room - std::min<std::size_t>(room, 1);
    for (std::size_t k = 0; k < shown; ++k) told.push_back(row(texts_of(rows[k]), widths, columns));
    if (rows.empty()) told.push_back(clipped("nothing is simulated", columns) + "\n");
    if (shown < rows.size()) told.push_back(clipped("and " + std::to_string(rows.size() - shown) + " more", columns) + "\n");
    std::string text;
    for (std::size_t k = 0; k < std::min(told.size(), lines); ++k) text += told[k];
    return text;
}

}  // namespace weave::simd
