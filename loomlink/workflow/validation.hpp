#pragma once

#include <weave/core/json.hpp>
#include <weave/loom/check.hpp>
#include <weave/loom/profile.hpp>

#include <loomlink/export/package.hpp>
#include <loomlink/store/writer.hpp>
#include <loomlink/workflow/cloths.hpp>
#include <map>
#include <string>
#include <vector>

namespace weave::loomlink {

/// The profile of a loom that is in force.
struct ProfileInForce {
    std::int64_t version = 0;
    LoomProfile profile;
};
Result<ProfileInForce> profile_in_force(const Reader& reader, Id loom);

/// What the server found when it held a revision to a loom: evidence of the kind `validation`.
struct Validation {
    std::string loom;
    std::int64_t profile_version = 0;
    std::string profile_sha256;
    std::size_t errors = 0, warnings = 0, not_evaluated = 0;
    std::map<std::string, std::size_t> error_rules;  ///< how many errors of each rule
    Seq event = 0;                                   ///< the record that tells of it
    std::string at;
};

/// Each of the design's feeders on the loom's of the same number, as long as nobody has said otherwise.
FeederMap straight_map(const weave::Design& design);

/// Every rule that libweave judges, with the controller's file written under the name `stem` and read again.
CheckReport check_with_file(const RevisionCloth& cloth, const LoomProfile& profile, const FeederMap& feeders,
                            const std::string& stem);
/// Holds a cloth to a loom.
Validation validate(const RevisionCloth& cloth, const std::string& loom, const ProfileInForce& profile,
                    const FeederMap& feeders, const std::string& stem);
/// As `weave check --json`.
Json to_json(const CheckReport& report);

/// What a record of the log says of it, and back.
Json to_data(const Validation& validation, const Revision& revision);
/// The newest validation of a revision for each loom.
Result<std::vector<Validation>> validations_of(const Reader& reader, const Design& design,
                                               const Revision& revision);

/// A waiver with what its record tells besides.
struct WaivedFinding {
    Waiver waiver;
    std::string loom;
};
Result<std::vector<WaivedFinding>> waivers_with_looms(const Reader& reader, Id revision);

/// The rules whose errors nobody waived for that loom, in words; empty: it counts.
std::vector<std::string> open_errors(const Validation& validation, const std::vector<WaivedFinding>& waived);

}  // namespace weave::loomlink
