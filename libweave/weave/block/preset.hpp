#pragma once

#include <weave/block/block.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace weave {

/// One option of a preset family.
struct PresetOption {
    std::string name;
    std::int64_t fallback = 0, low = 0, high = 0;
    std::string help;  ///< one line for a weaver
};

/// A family of weaves that a rule makes in any size.
struct PresetFamily {
    std::string name;  ///< lower case with hyphens
    std::string help;  ///< one line for a weaver
    std::vector<PresetOption> options;
};

/// plain, twill, satin, sateen, rib, basket, layer-to-layer, angle-interlock, orthogonal, multi-layer and
/// more.
const std::vector<PresetFamily>& preset_families();

/// A family and the options that differ from its defaults.
struct Preset {
    std::string family;
    std::map<std::string, std::int64_t> options;
    friend bool operator==(const Preset&, const Preset&) = default;
};

/// Errors: a family, option or value that does not exist, or values that do not go together (a satin move
/// that shares a factor with its size, say), with what would be possible.
Result<Block> make_preset(const Preset& preset);

}  // namespace weave
