#pragma once

#include <loomlink/export/hook_plan.hpp>
#include <string>
#include <vector>

namespace weave::loomlink {

/// What a controller's file calls itself.
struct InFileNames {
    std::string name;     ///< printable ASCII, at least one that is no blank where the format has a name
    std::string comment;  ///< JC5 only: printable ASCII, at most 255
};

/// A file for a controller, laid out as files of mills were observed to be; no maker has certified it.
struct WrittenFile {
    std::string bytes;
    InFileNames names;                        ///< as they stand in the file; empty where the format has none
    bool name_cut = false;                    ///< the wish was longer than the file has room for
    std::vector<std::string> unknown_fields;  ///< written as observed, meaning unknown
    std::vector<std::string>
        assumed;  ///< what this file does that no observed file did: by the profile or by us
};

/// The bytes of JC5 (Stäubli), EP (Bonas) and headerless raw files; README.md beside this file has them byte
/// by byte. Names are cut at 8 characters, or at the profile's limit where that is lower; blanks at the end
/// of names and comments are left out, since readers take them for filling. Errors: names and area names that
/// the format cannot hold, more picks, hooks or blocks than its numbers can count, function bytes in a JC5.
Result<WrittenFile> write_jc5(const HookPlan& plan, const LoomProfile& profile, const InFileNames& names);
Result<WrittenFile> write_ep(const HookPlan& plan, const LoomProfile& profile, const InFileNames& names);
Result<WrittenFile> write_raw(const HookPlan& plan, const LoomProfile& profile);

/// The one of them that the profile asks for. Error: a profile whose loom takes a picture.
Result<WrittenFile> write_controller_file(const HookPlan& plan, const LoomProfile& profile,
                                          const InFileNames& names);

/// The name as a file holds it, without blanks at its end; `cut` tells whether the wish was longer. Errors:
/// nothing but blanks, or not printable ASCII.
struct FittedName {
    std::string name;
    bool cut = false;
};
Result<FittedName> fit_name(const std::string& wish, const LoomProfile& profile);

}  // namespace weave::loomlink
