#pragma once

#include <weave/core/result.hpp>

#include <string>
#include <vector>

/// Runs of one design that differ in numbers of the scene (`weave simulate --sweep`).
namespace weave::program {

/// As many as a server keeps for one person.
inline constexpr std::size_t most_runs = 1000;

/// What the words of --sweep mean, each `friction=0,0.1,0.2`: for each run what --set would be given, `friction=0.1`, all of the
/// combinations, the last word's values changing first. Errors: usage, naming the word.
Result<std::vector<std::vector<std::string>>> runs_of_sweep(const std::vector<std::string>& words);

}  // namespace weave::program
