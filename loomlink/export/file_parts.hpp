#pragma once

#include <cstddef>
#include <cstdint>
#include <loomlink/export/controller_files.hpp>
#include <string>
#include <string_view>

/// What the writers of controller files share, no interface of the folder.
namespace weave::loomlink {

/// Characters of a name in JC5 and EP files.
inline constexpr std::size_t name_room = 8;

bool is_printable(std::string_view text);

/// Without the blanks at its end, which fill a field and are no part of its text.
std::string without_filling(const std::string& text);

inline void put_little(std::string& out, std::uint32_t value, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) out.push_back(static_cast<char>(value >> 8 * k & 0xff));
}

inline void put_big32(std::string& out, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<char>(value >> shift & 0xff));
}

/// Ways of the profile that no observed file of this format showed.
void note_settings(WrittenFile& file, const HookPlan& plan, const LoomProfile& profile);

}  // namespace weave::loomlink
