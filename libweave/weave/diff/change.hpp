#pragma once

#include <weave/core/json.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace weave {

enum class ChangeKind : std::uint8_t { added, removed, changed, renamed, moved };

/// `added`, `removed` and so on.
const std::string& name_of(ChangeKind kind);

/// Picks or ends `first`, `first + step` … `last`, in the numbers of the design after; from 0.
struct LineRange {
    std::size_t first = 0, last = 0, step = 1;
    friend bool operator==(const LineRange&, const LineRange&) = default;
};

/// One thing that differs between two designs, in words and as data.
struct Change {
    ChangeKind kind = ChangeKind::changed;
    std::string where;   ///< place in the document, as in errors: `weft.yarns[1].radius_mm`
    std::string text;    ///< one line for a weaver, numbers from 1; foreign names are fit for a terminal
    Json before, after;  ///< what the place held, as in the document; null where it held nothing
    std::size_t count =
        0;  ///< how many picks, ends, stacks or crossings it concerns, where it can be counted
    std::vector<LineRange> lines{};  ///< picks or ends that it concerns, where it is about them
};
using Changes = std::vector<Change>;

/// A value of a document for a person: short, on one line.
std::string shown(const Json& value);
/// A foreign text in quotation marks, on one line and not too long.
std::string in_quotes(std::string_view text, std::size_t most_bytes = 60);
/// `was 0.15 mm, is 0.2 mm`; `is 0.2 mm, was not set`.
std::string was_and_is(const Json& before, const Json& after, const std::string& unit = {});

/// `pick 3`, `picks 3 to 7`, `picks 2, 4 … 16 (every 2nd)`; a long list ends with how many ranges follow.
std::string lines_in_words(const std::string& noun, const std::vector<LineRange>& lines);

/// Rising numbers as ranges of equal steps.
std::vector<LineRange> ranges_of(const std::vector<std::size_t>& lines);

/// A list of an answer is not longer; how long it is stands beside it.
inline constexpr std::size_t most_listed = 1000;

Json to_json(const Change& change);
Json to_json(const Changes& changes);
Json to_json(const std::vector<LineRange>& lines);  ///< numbers from 1

}  // namespace weave
