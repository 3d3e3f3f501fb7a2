#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace weave {

/// The whole number that `text` is, all of it; nothing otherwise.
std::optional<std::int64_t> parse_whole(std::string_view text);

/// Whether the bytes are UTF-8 (RFC 3629): no overlong forms, no surrogates, nothing beyond U+10FFFF.
bool is_utf8(std::string_view text);

/// Bytes of the UTF-8 character that `text` starts with; 0 where it starts with none or is empty.
std::size_t utf8_length(std::string_view text);

/// `text` as a terminal can show it on one line, whoever wrote it: control characters (C0, DEL, C1), line and
/// paragraph separators, marks that turn the direction of writing, and bytes that are no UTF-8 appear as
/// `\x1b` or `\u202e`; all else stays. For every name from a file or a call that is told to a person.
std::string on_one_line(std::string_view text);

/// The shortest list whose repetition is `list`: 2 of 2, 2, 2, 2.
std::vector<std::uint32_t> shortest_repeat(std::span<const std::uint32_t> list);

/// `1 pick`, `2 picks`.
std::string counted(std::size_t number, const std::string& noun);

/// A place in a list of a document: `flips[3]`.
std::string indexed(const std::string& list, std::size_t index);

}  // namespace weave
