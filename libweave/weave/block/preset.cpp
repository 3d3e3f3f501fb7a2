#include <weave/block/preset.hpp>

#include <weave/block/preset_rules.hpp>

#include <algorithm>

namespace weave {

namespace {

const std::vector<presets::Rule>& rules() {
    static const std::vector<presets::Rule> all = [] {
        std::vector<presets::Rule> joined = presets::flat_rules();
        for (auto& rule : presets::layered_rules()) joined.push_back(rule);
        return joined;
    }();
    return all;
}

template <class Items>
std::string names_of(const Items& items) {
    std::string text;
    for (const auto& item : items) text += (text.empty() ? "" : ", ") + item.name;
    return text;
}

Error unknown_option(const PresetFamily& family, const std::string& name) {
    if (family.options.empty())
        return bad_input("'" + family.name + "' has no options, so no '" + name + "'");
    return bad_input("'" + family.name + "' has no option '" + name + "', only " + names_of(family.options));
}

/// The family's defaults with the given options in their place.
Result<presets::Values> values_for(const PresetFamily& family, const Preset& preset) {
    std::map<std::string, std::int64_t> values;
    for (const PresetOption& option : family.options) values[option.name] = option.fallback;
    for (const auto& [name, value] : preset.options) {
        const auto option =
            std::find_if(family.options.begin(), family.options.end(),
                         [&name = name](const PresetOption& known) { return known.name == name; });
        if (option == family.options.end()) return unknown_option(family, name);
        if (value < option->low || value > option->high) {
            return bad_input("'" + family.name + "' takes " + name + " from " + std::to_string(option->low) +
                             " to " + std::to_string(option->high) + ", not " + std::to_string(value));
        }
        values[name] = value;
    }
    return presets::Values(std::move(values));
}

}  // namespace

const std::vector<PresetFamily>& preset_families() {
    static const std::vector<PresetFamily> families = [] {
        std::vector<PresetFamily> list;
        for (const presets::Rule& rule : rules()) list.push_back(rule.family);
        return list;
    }();
    return families;
}

Result<Block> make_preset(const Preset& preset) {
    const auto rule = std::find_if(rules().begin(), rules().end(), [&](const presets::Rule& known) {
        return known.family.name == preset.family;
    });
    if (rule == rules().end()) {
        return bad_input("there is no preset family '" + preset.family.substr(0, 60) + "', only " +
                         names_of(preset_families()));
    }
    WEAVE_TRY(const presets::Values values, values_for(rule->family, preset));
    return rule->make(values);
}

}  // namespace weave
