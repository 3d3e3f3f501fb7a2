#pragma once

#include <weave/core/json.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/loom/profile.hpp>

#include <string>
#include <utility>
#include <vector>

namespace weave {

/// The files of a sample for one loom: what `weave export` hands out before loomlink releases anything.
struct SampleExport {
    std::vector<std::pair<std::string, std::string>> files;  ///< name and bytes; the manifest is among them
    Json manifest;
};

/// Card image, pick table and manifest of a cloth for a loom. Every name and the manifest say SAMPLE, NOT
/// RELEASED. The manifest states polarity, orientation, bit order, face, sizes and hashes; of the loom its
/// name, maker, `revision`, and as `sha256` LoomProfile::sha256, the hash of the profile's canonical bytes,
/// not of its file. The card image is read back by the decoder and compared before anything is handed out; an
/// error where it differs. The cloth must have been validated by the caller.
Result<SampleExport> make_sample_export(const Design& design, const Evaluation& cloth,
                                        const LoomProfile& profile, const std::string& stem);

}  // namespace weave
