#pragma once

#include <weave/loom/profile.hpp>

#include <algorithm>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// An encoder of controller files for tests, apart from the readers and from loomlink's writers: it lays bits
/// out as text of 0 and 1 in the order of the file, and only then makes bytes of them.
namespace weave::testing {

/// Lifted hooks of each pick as texts, `X` lifted: `picks[pick][hook]`; picks as woven, hooks as the profile
/// counts.
using Shed = std::vector<std::string>;

/// A number as bytes, the highest first (JC5) or last (EP).
inline std::string big_bytes(std::uint64_t number, std::size_t count) {
    std::string bytes(count, '\0');
    for (auto byte = bytes.rbegin(); byte != bytes.rend(); ++byte, number /= 256)
        *byte = static_cast<char>(number % 256);
    return bytes;
}
inline std::string little_bytes(std::uint64_t number, std::size_t count) {
    std::string bytes = big_bytes(number, count);
    std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

/// The hook bytes of one pick.
inline std::string hook_bytes(const std::string& hooks, const LoomProfile& profile) {
    std::string places(hooks.size(), '?');
    for (std::size_t hook = 0; hook < hooks.size(); ++hook) {
        const std::size_t place = profile.hook_permutation.empty() ? hook : profile.hook_permutation.at(hook);
        places.at(place) = (hooks[hook] == 'X') == profile.lifted_is_one ? '1' : '0';
    }
    std::string bits;
    std::size_t at = 0;
    const char filling = profile.lifted_is_one ? '0' : '1';
    const auto fill = [&] { bits.append((8 - bits.size() % 8) % 8, filling); };
    for (const HookArea& area : profile.areas) {
        bits += places.substr(at, area.hooks);
        at += area.hooks;
        if (profile.areas_on_bytes) fill();
    }
    fill();
    std::string bytes;
    for (at = 0; at < bits.size(); at += 8) {
        std::string eight = bits.substr(at, 8);  // read by bitset with the highest bit in front
        if (profile.least_bit_first) std::reverse(eight.begin(), eight.end());
        bytes += static_cast<char>(std::bitset<8>(eight).to_ulong());
    }
    return bytes;
}

/// The function word of each pick, or none where all are 0.
using Words = std::vector<std::uint64_t>;

/// The records of all picks, each with its function bytes in front.
inline std::string record_bytes(const Shed& shed, const Words& words, const LoomProfile& profile) {
    std::vector<std::string> records;
    for (std::size_t pick = 0; pick < shed.size(); ++pick) {
        const std::string function = little_bytes(words.empty() ? 0 : words[pick], profile.function_bytes);
        records.push_back(function + hook_bytes(shed[pick], profile));
    }
    if (!profile.pick_1_at_bottom) std::reverse(records.begin(), records.end());
    std::string all;
    for (const std::string& record : records) all += record;
    return all;
}

inline std::string jc5_field(std::uint32_t tag, const std::string& value) {
    return big_bytes(tag, 4) + big_bytes(value.size(), 4) + value;
}

inline std::string jc5_bytes(const std::string& name, const std::string& comment, const Shed& shed,
                             const LoomProfile& profile) {
    std::string bytes = "\x81\xfe\x01\x01" + big_bytes(4, 4);
    std::string field = name.substr(0, 8);
    field.resize(9, '\0');
    bytes += jc5_field(1, field) + jc5_field(2, big_bytes(shed.size(), 4)) + jc5_field(6, big_bytes(0, 4));
    bytes += jc5_field(8, comment + std::string(1, '\0')) + big_bytes(profile.areas.size(), 4);
    for (const HookArea& area : profile.areas)
        bytes +=
            jc5_field(0x64, big_bytes(1, 4) + big_bytes(area.hooks, 4) + area.name + std::string(1, '\0'));
    return bytes + record_bytes(shed, {}, profile);
}

inline std::string ep_bytes(const std::string& name, const Shed& shed, const Words& words,
                            const LoomProfile& profile) {
    const std::string records = record_bytes(shed, words, profile);
    std::size_t blocks = 1;
    while (blocks * 4096 < 32 + records.size()) ++blocks;
    std::string field = name.substr(0, 8);
    field.resize(8, '\0');
    std::string bytes = little_bytes(blocks, 2) + std::string(1, '\0') + little_bytes(shed.size(), 2);
    bytes += std::string(1, '\0') + field + '\0' + static_cast<char>(profile.function_bytes);
    bytes.resize(31, '\0');
    bytes += '\x12' + little_bytes(shed.front().size(), 2) + records;
    bytes.resize(2 + 4096 * blocks, '\xff');
    return bytes + std::string(1022, '\0');
}

inline std::string raw_bytes(const Shed& shed, const LoomProfile& profile, const Words& words = {}) {
    return record_bytes(shed, words, profile);
}

}  // namespace weave::testing
