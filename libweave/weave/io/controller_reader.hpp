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

/// Text of a field that NULs or blanks fill up, fit to be shown. What a field should not hold is told:
/// anything after the first NUL, and characters that cannot be shown.
std::string text_of(std::string_view field, std::size_t offset, const std::string& what, Oddities& oddities);

/// The hook bits of every pick, in the profile's hook numbers, lifted or not. Each record of `file`
/// (records_at, record_bytes) ends with hooks / 8 bytes of hook bits; all `picks` of them lie within `bytes`.
/// Errors: a number of hooks that fills no whole bytes, or a permutation that does not fit it.
Status read_lifts(std::string_view bytes, std::size_t picks, const LoomProfile& profile,
                  ControllerFile& file);

/// An error unless so many hooks fill whole bytes: how a file would pack others is not known.
Status check_whole_bytes(std::size_t hooks, std::size_t offset);

Result<ControllerFile> read_jc5(std::string_view bytes, const LoomProfile& profile);
Result<ControllerFile> read_ep(std::string_view bytes, const LoomProfile& profile);
Result<ControllerFile> read_raw(std::string_view bytes, const LoomProfile& profile);

/// JC5 files start with these bytes.
inline constexpr std::string_view jc5_magic{"\x81\xfe\x01\x01", 4};
/// Whether the header and the size of a file fit together as those of EP files do.
bool looks_like_ep(std::string_view bytes);

}  // namespace weave::controller
