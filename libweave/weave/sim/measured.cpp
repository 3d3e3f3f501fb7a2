#include <weave/sim/measured.hpp>

#include <weave/core/text.hpp>

#include <charconv>
#include <cmath>
#include <optional>
#include <string>

namespace weave {

namespace {

constexpr double farthest = 1e9;

/// The lines of a text that say something, split into words.
class Lines {
  public:
    explicit Lines(std::string_view text) : m_text(text) {
        if (m_text.starts_with("\xef\xbb\xbf")) m_text.remove_prefix(3);  // a byte order mark
    }
    /// Goes on to the next line with words; false after the last.
    bool next() {
        m_words.clear();
        while (m_words.empty() && !m_text.empty()) {
            const std::size_t end = m_text.find('\n');
            split(m_text.substr(0, end));
            m_text.remove_prefix(end == std::string_view::npos ? m_text.size() : end + 1);
            ++m_line;
        }
        return !m_words.empty();
    }
    [[nodiscard]] const std::vector<std::string_view>& words() const { return m_words; }
    [[nodiscard]] std::size_t line() const { return m_line; }
    [[nodiscard]] std::string place() const { return "line " + std::to_string(m_line); }
    /// The least room that one more point takes: so many points may still come.
    [[nodiscard]] std::size_t most_points_left() const { return m_text.size() / 5 + 1; }

  private:
    void split(std::string_view line) {
        line = line.substr(0, line.find('#'));
        constexpr std::string_view spaces = " \t\r";
        for (std::size_t at = line.find_first_not_of(spaces); at != std::string_view::npos;) {
            const std::size_t end = line.find_first_of(spaces, at);
            m_words.push_back(line.substr(at, end - at));
            at = line.find_first_not_of(spaces, end);
        }
    }
    std::string_view m_text;
    std::vector<std::string_view> m_words;
    std::size_t m_line = 0;
};

std::string quoted(std::string_view word) {
    const std::string_view start = word.substr(0, 40);
    return is_utf8(start) ? "'" + std::string(start) + "'" : "a word that is not UTF-8";
}

Result<std::size_t> read_count(const Lines& lines) {
    if (lines.words().size() != 1)
        return bad_input("a yarn begins with the number of its points alone on a line", lines.place());
    const auto count = parse_whole(lines.words()[0]);
    if (!count)
        return bad_input("must be a number of points, not " + quoted(lines.words()[0]), lines.place());
    if (*count < 2 || static_cast<std::uint64_t>(*count) > most_measured_points)
        return bad_input("a yarn has from 2 to " + std::to_string(most_measured_points) + " points",
                         lines.place());
    return static_cast<std::size_t>(*count);
}

Result<Vec3> read_place(const Lines& lines) {
    if (lines.words().size() != 3) return bad_input("a point is three numbers, x y z", lines.place());
    Vec3 place;
    for (int axis = 0; axis < 3; ++axis) {
        const std::string_view word = lines.words()[static_cast<std::size_t>(axis)];
        const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), place[axis]);
        if (code != std::errc{} || end != word.data() + word.size() || !(std::abs(place[axis]) <= farthest))
            return bad_input("must be a number between -1e9 and 1e9, not " + quoted(word), lines.place());
    }
    return place;
}

}  // namespace

Result<std::vector<MeasuredYarn>> read_measured(std::string_view text) {
    Lines lines(text);
    std::vector<MeasuredYarn> yarns;
    std::size_t points = 0;
    while (lines.next()) {
        WEAVE_TRY(const std::size_t count, read_count(lines));
        points += count;
        if (points > most_measured_points) {
            return bad_input("the yarns have more than " + std::to_string(most_measured_points) + " points",
                             lines.place());
        }
        MeasuredYarn yarn;
        yarn.line = lines.line();
        if (count <= lines.most_points_left()) yarn.places.reserve(count);
        while (yarn.places.size() < count) {
            if (!lines.next()) {
                return bad_input("the file ends after " + counted(yarn.places.size(), "point") + " of the " +
                                     std::to_string(count) + " of this yarn",
                                 "line " + std::to_string(yarn.line));
            }
            WEAVE_TRY(const Vec3 place, read_place(lines));
            yarn.places.push_back(place);
        }
        yarns.push_back(std::move(yarn));
    }
    if (yarns.empty()) return bad_input("there is no yarn in this file");
    return yarns;
}

}  // namespace weave
