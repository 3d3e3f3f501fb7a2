#pragma once

// What the content of a `.yarns` file must be, for its writer and its reader alike; no part of the library's face.

#include <weave/core/json.hpp>
#include <weave/sim/yarns.hpp>

#include <string>

namespace weave::yarns_detail {

/// `yarns[3]`
std::string yarn_place(std::size_t yarn);
/// Whether a number is finite and within what a file may hold.
bool is_number(double value);

Status check_hash(const std::string& hash, const char* name);
/// As many numbers of each kind as there are control points.
Status check_sizes(const SimulatedYarn& yarn);
/// The numbers themselves.
Status check_points(const SimulatedYarn& yarn);
/// An end is one yarn, and a pick has one of each feeder: whoever looks for one by its number finds it.
Status check_numbers(const Yarns& yarns);
/// What repeats does so after some length.
Status check_periods(const Yarns& yarns);
Status check_crossings(const Yarns& yarns);
/// None of its members need be there, but what is there is what a run can have ended with.
Status check_report(const Json& report);

}  // namespace weave::yarns_detail
