#pragma once

#include <weave/core/json_reader.hpp>
#include <weave/keys/utc.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

namespace weave {

/// Whole numbers in signed documents stay below this (2^53), where JSON's numbers are exact.
inline constexpr std::int64_t most_count = 9007199254740991;

/// Checks `format` and `version` 1 of a document, with a sentence for a newer one.
void read_heading(JsonReader& reader, const std::string& format);

/// A member that is a lower-case hexadecimal text of exactly so many characters.
std::string hex_member(JsonReader& reader, const std::string& key, std::size_t characters);

/// A member that names something to people: 1 to 128 bytes without control characters.
std::string name_member(JsonReader& reader, const std::string& key);

/// A member that is a moment as utc_text() writes it.
Instant utc_member(JsonReader& reader, const std::string& key);

/// A member that counts, from `low`.
std::uint64_t count_member(JsonReader& reader, const std::string& key, std::int64_t low = 0,
                           std::int64_t high = most_count);

}  // namespace weave
