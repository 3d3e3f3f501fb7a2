#pragma once

#include <weave/core/json.hpp>
#include <weave/design/evaluate.hpp>

#include <loomlink/export/controller_files.hpp>
#include <loomlink/export/read_back.hpp>
#include <set>
#include <string>
#include <vector>

namespace weave::loomlink {

/// Under which names a release leaves the house.
struct ReleaseNames {
    std::string stem;     ///< of all files; made plain (letters, digits, `-`, `_`)
    InFileNames in_file;  ///< of JC5 and EP files; not looked at for other formats
};

/// Files that are handed out beside those that the loom needs.
enum class ExtraFile : std::uint8_t { png, tiff, bmp, wif };

struct PackageFile {
    std::string path;    ///< a name without folders
    std::string format;  ///< jc5, ep, raw, png, tiff, bmp, wif or pick-table-csv
    std::string bytes;
};

/// All that a release of one revision to one loom hands out.
struct ReleasePackage {
    std::vector<PackageFile> files;  ///< first the loom's own, then the pick table, then the rest
    Json manifest;                   ///< the body that is signed; README.md beside this file has its members
    std::vector<std::string> notes;  ///< for the person who releases, such as a name that was cut
};

/// The files of a cloth for a loom, each read back and compared before anything is handed out: the
/// controller's file by `decoder`, pictures and WIF by the readers of libweave, the pick table by a reader of
/// its own. For a loom that takes a controller's file a PNG of the card is among them, to look at. The caller
/// has validated the cloth and found out that it may be released: this function signs nothing and judges no
/// rights. Errors: `invalid` where the cloth does not go on the loom or a name not into the file, `system`
/// where a file does not read back.
Result<ReleasePackage> make_release_package(const weave::Design& design, const Evaluation& cloth,
                                            const LoomProfile& profile, const FeederMap& feeders,
                                            const ReleaseNames& names, const std::set<ExtraFile>& extras,
                                            const ControllerDecoder& decoder);

}  // namespace weave::loomlink
