#pragma once

#include <weave/block/block.hpp>

#include <loomlink/export/controller_files.hpp>
#include <loomlink/export/hook_plan.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace weave::loomlink {

/// What a controller's file says, as a decoder reads it that shares no code with the writer.
struct DecodedFile {
    InFileNames names;  ///< as they stand in the file; empty where the format has none
    LiftTable lifts;    ///< every hook and record as the loom weaves them, lead-in first; hooks in the
                        ///< controller's order
    CardImage card;     ///< the design's picks and ends, by the decoder's own reading of the profile
    std::vector<std::vector<std::size_t>> feeders;  ///< of the loom, from 0, in rising order, for each pick
                                                    ///< of the card; without encoding: all empty
    std::vector<std::string>
        oddities;  ///< what is not as in files that were observed, or as the profile asks
};

/// A controller's file of a cloth with `ends` ends, read by the readers of weave/io. Errors: what they
/// refuse.
Result<DecodedFile> decode_controller_file(std::string_view bytes, const LoomProfile& profile,
                                           std::size_t ends);

/// An error of the system, which names the first pick and hook, unless the file was read with the names,
/// every lift, the card and the feeders that were planned, and without an oddity.
Status check_decoded(const DecodedFile& read, const InFileNames& names, const HookPlan& plan,
                     const CardImage& card, const LoomProfile& profile);

/// The same of a file that decode_controller_file() reads; an error of the system where it does not.
Status check_controller_file(std::string_view bytes, const InFileNames& names, const HookPlan& plan,
                             const CardImage& card, const LoomProfile& profile);

/// An error of the system unless the text, read as CSV, has the picks in order with their rows, feeders of
/// design and loom, directions and take-up.
Status check_pick_table(std::string_view csv, const std::vector<Pick>& picks, const FeederMap& feeders);

/// An error of the system unless the WIF file, read by read_wif, has this card and these picks.
Status check_wif(std::string_view text, const CardImage& card, const std::vector<Pick>& picks);

}  // namespace weave::loomlink
