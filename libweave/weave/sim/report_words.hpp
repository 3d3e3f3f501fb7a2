#pragma once

// Reading a report that may come from anyone's file, and saying parts of it.

#include <weave/core/json.hpp>
#include <weave/sim/yarns.hpp>

#include <array>
#include <cstdio>
#include <string>

namespace weave::sim {

/// A member of an object, or null.
inline Json part_of(const Json& object, const char* name) {
    return object.is_object() && object.contains(name) ? object.at(name) : Json(nullptr);
}

/// A member that is a number, or 0.
inline double number_in(const Json& object, const char* name) {
    const Json part = part_of(object, name);
    return part.is_number() ? part.get<double>() : 0;
}

/// What the plan of a run chose for a term such as `boundary x`, or nothing.
inline std::string plan_choice(const Json& report, const char* term) {
    const Json plan = part_of(report, "plan");
    if (!plan.is_array()) return "";
    for (const Json& line : plan) {
        const Json choice = part_of(line, "choice");
        if (part_of(line, "term") == term && choice.is_string()) return choice.get<std::string>();
    }
    return "";
}

/// `smallest_curvature` of a report, or null. Files of earlier versions only said where they saw one below 0.
inline Json smallest_curvature(const Json& report) {
    Json curvature = part_of(report, "smallest_curvature");
    if (curvature.is_null() && part_of(report, "curves_down") == true) return "negative";
    return curvature;
}

inline std::string short_format(const char* pattern, double value) {
    std::array<char, 120> text{};
    std::snprintf(text.data(), text.size(), pattern, value);
    return text.data();
}

/// `kind` and `number`, from 1, of a yarn.
inline Json yarn_json(const SimulatedYarn& yarn) {
    return {{"kind", yarn.system == System::warp ? "end" : "pick"}, {"number", yarn.number + 1}};
}

/// ` (end 3)` of the same, or nothing.
inline std::string yarn_words(const Json& object) {
    const Json kind = part_of(object, "kind");
    if (kind != "end" && kind != "pick") return "";
    return " (" + kind.get<std::string>() + short_format(" %.0f)", number_in(object, "number"));
}

}  // namespace weave::sim
