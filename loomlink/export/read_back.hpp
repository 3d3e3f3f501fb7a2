#pragma once

#include <weave/block/block.hpp>

#include <functional>
#include <loomlink/export/hook_plan.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace weave::loomlink {

/// What a controller's file says, as a decoder reads it that shares no code with the writer.
struct DecodedFile {
    std::string name;  ///< as it stands in the file; empty where the format has none
    LiftTable lifts;   ///< every hook and record as the loom weaves them, lead-in first; hooks in the
                       ///< controller's order
    CardImage card;    ///< the design's picks and ends, by the decoder's own reading of the profile
    std::vector<std::vector<std::size_t>> feeders;  ///< of the loom, from 0, in rising order, for each pick
                                                    ///< of the card; without encoding: all empty
};

/// Reads a controller's file of a cloth with `ends` ends.
using ControllerDecoder =
    std::function<Result<DecodedFile>(std::string_view bytes, const LoomProfile& profile, std::size_t ends)>;

/// An error of the system, which names the first pick and hook, unless the decoder reads from `bytes` the
/// name, every lift, the card and the feeders that were planned. Without a decoder: an error.
Status check_controller_file(std::string_view bytes, const std::string& name, const HookPlan& plan,
                             const CardImage& card, const LoomProfile& profile,
                             const ControllerDecoder& decoder);

/// An error of the system unless the text, read as CSV, has the picks in order with their rows, feeders of
/// design and loom, directions and take-up.
Status check_pick_table(std::string_view csv, const std::vector<Pick>& picks, const FeederMap& feeders);

/// An error of the system unless the WIF file, read by read_wif, has this card and these picks.
Status check_wif(std::string_view text, const CardImage& card, const std::vector<Pick>& picks);

}  // namespace weave::loomlink
