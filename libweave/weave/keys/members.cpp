#include <weave/keys/members.hpp>

#include <weave/core/text.hpp>
#include <weave/keys/hex.hpp>

namespace weave {

void read_heading(JsonReader& reader, const std::string& format) {
    if (reader.text("format", {}, 64) != format) reader.fail("must be " + format, "format");
    const auto version = reader.integer("version", 1, most_count);
    if (version > 1)
        reader.fail("is " + std::to_string(version) + ", newer than this program, which reads version 1",
                    "version");
}

std::string hex_member(JsonReader& reader, const std::string& key, std::size_t characters) {
    std::string text = reader.text(key, {}, characters);
    if (!reader.failed() && !is_hex(text, characters))
        reader.fail("must be " + std::to_string(characters) + " lower-case hexadecimal characters", key);
    return text;
}

std::string name_member(JsonReader& reader, const std::string& key) {
    constexpr std::size_t longest = 128;
    std::string text = reader.text(key, {}, longest);
    if (!reader.failed() && (text.empty() || on_one_line(text) != text))
        reader.fail("must be a name: not empty, without control characters", key);
    return text;
}

Instant utc_member(JsonReader& reader, const std::string& key) {
    const std::string text = reader.text(key, {}, 64);
    if (reader.failed()) return {};
    const auto instant = parse_utc(text);
    if (instant) return *instant;
    reader.fail(instant.error().message, key);
    return {};
}

std::uint64_t count_member(JsonReader& reader, const std::string& key, std::int64_t low, std::int64_t high) {
    return static_cast<std::uint64_t>(reader.integer(key, low, high));
}

}  // namespace weave
