#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace weave {

/// The whole number that `text` is, all of it; nothing otherwise.
std::optional<std::int64_t> parse_whole(std::string_view text);

/// Whether the bytes are UTF-8 (RFC 3629): no overlong forms, no surrogates, nothing beyond U+10FFFF.
bool is_utf8(std::string_view text);

/// `1 pick`, `2 picks`.
std::string counted(std::size_t number, const std::string& noun);

/// A place in a list of a document: `flips[3]`.
std::string indexed(const std::string& list, std::size_t index);

}  // namespace weave
