#pragma once

#include <algorithm>
#include <array>
#include <loomlink/store/records.hpp>
#include <string_view>

namespace weave::loomlink::words {

// In the order of the enumerations. They stand in stores: do not change them.
inline constexpr std::array roles{"designer", "approver", "operator", "engineer", "administrator"};
inline constexpr std::array revision_states{"draft",    "submitted",  "approved", "changes_requested",
                                            "released", "superseded", "withdrawn"};
inline constexpr std::array decisions{"approve", "request_changes"};
inline constexpr std::array release_states{"prepared", "released", "superseded", "withdrawn"};

/// The value that a word of the store stands for; the database holds no other words.
template <class Value, std::size_t N>
Value value_of(const std::array<const char*, N>& words, std::string_view word) {
    const auto place = std::find(words.begin(), words.end(), word);
    return static_cast<Value>(std::min<std::ptrdiff_t>(place - words.begin(), N - 1));
}

}  // namespace weave::loomlink::words
