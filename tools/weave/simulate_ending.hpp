#pragma once

#include "command.hpp"

#include <weave/block/flip.hpp>
#include <weave/core/json.hpp>

#include <cstddef>
#include <string>
#include <vector>

/// How `weave simulate` ended, in words and for programs, whoever computed.
namespace weave::program {

/// What a run was asked for beside coming to rest.
struct Asked {
    std::size_t flips = 0, starts = 0;
    bool symmetry = false;
};

/// What a run that was interrupted, or whose time or steps were up, was asked for and has not done, in words.
std::vector<std::string> left_undone(const Json& report, const Asked& asked);

/// A report over some lines.
std::string ending_in_words(const Json& report);

/// At rest, every crossing as the card says, and all done that was asked for.
bool is_good(const Json& report);

/// A design with those of the flips that the report says were made.
Result<Design> with_flips_made(Design design, const std::vector<Flip>& flips, const Json& report);

/// Where the design goes that has the flips which were made; an empty file: nowhere.
struct FlippedDesign {
    const Design& design;  ///< as its file has it
    std::vector<Flip> flips;
    std::string file;
};

/// Saves the flipped design, answers, and says by the exit status whether it is good. `answer` is the report, with what
/// else is told; it has `file`.
Status tell_ending(CommandOutcome& outcome, const Json& report, Json answer, const FlippedDesign& flipped);

}  // namespace weave::program
