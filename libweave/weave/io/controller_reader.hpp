#pragma once

// Shared by the readers of controller files; no part of the library's face.

#include <weave/io/controller_file.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace weave::controller {

/// How a message names a place in a file.
std::string at_byte(std::size_t offset);
/// `81 fe`: at most 16 bytes, then an ellipsis.
std::string hexadecimal(std::string_view bytes);

inline std::uint8_t byte_at(std::string_view bytes, std::size_t at) {
    return static_cast<std::uint8_t>(bytes[at]);
}
std::uint32_t little(std::string_view bytes, std::size_t at, std::size_t count);

/// What was odd about a file, a bounded number of times, each with its place.
class Oddities {
  public:
    void add(std::size_t offset, const std::string& message);
    [[nodiscard]] std::vector<std::string> take() &&;

  private:
    std::vector<std::string> m_texts;
    std::size_t m_left_out = 0;
};

/// Text of a field that NULs fill up, fit to be shown. What a field should not hold is told:
/// anything after the first NUL, and characters that cannot be shown.
std::string text_of(std::string_view field, std::size_t offset, const std::string& what, Oddities& oddities);

/// Where a bit stands among the hook bytes of a record.
struct BitPlace {
    std::size_t byte = 0;
    std::uint8_t mask = 1;
};

/// How the profile lays the hooks out in a record, after its function bytes.
struct HookLayout {
    std::size_t function_bytes = 0, hook_bytes = 0;
    std::vector<BitPlace> hooks;        ///< of each hook
    std::vector<std::uint8_t> no_hook;  ///< of each hook byte: the bits that belong to no hook

    [[nodiscard]] std::size_t bytes() const { return function_bytes + hook_bytes; }
};

/// Errors: areas that do not add up to the hooks, a permutation that is none of them, more function bytes
/// than the format has.
Result<HookLayout> hook_layout(const LoomProfile& profile);

/// What the records say, into `file`, whose records_at is set: the hooks of every pick in the profile's hook
/// numbers, lifted or not, and the function words. All `picks` records lie within `bytes`. Bits of no hook
/// that are not down are told.
void read_records(std::string_view bytes, std::size_t picks, const LoomProfile& profile,
                  const HookLayout& layout, ControllerFile& file, Oddities& oddities);

Result<ControllerFile> read_jc5(std::string_view bytes, const LoomProfile& profile);
Result<ControllerFile> read_ep(std::string_view bytes, const LoomProfile& profile);
Result<ControllerFile> read_raw(std::string_view bytes, const LoomProfile& profile);

/// A function word of a pick has room for so many.
inline constexpr std::size_t most_function_bytes = 8;
/// JC5 files start with these bytes.
inline constexpr std::string_view jc5_magic{"\x81\xfe\x01\x01", 4};
/// Whether the header and the size of a file fit together as those of EP files do.
bool looks_like_ep(std::string_view bytes);

}  // namespace weave::controller
