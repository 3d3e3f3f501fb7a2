#pragma once

#include <weave/core/json.hpp>

#include <string>
#include <vector>

namespace weave::simd {

/// The status of a machine (Daemon::status() without names) as a page that renews itself, without scripts and outside resources.
std::string status_page(const Json& status, const std::string& version);

/// Sessions or jobs of a status for people: what computes comes first, then what waits, then what rests.
std::vector<Json> busiest_first(const Json& works);

/// What a session or a job does, for people: `at rest`.
std::string phase_text(const Json& work);

/// A time for people, such as `3 min 20 s`.
std::string time_text(double seconds);

}  // namespace weave::simd
