#pragma once

#include <loomlink/export/package.hpp>
#include <loomlink/keys/release_manifest.hpp>
#include <loomlink/workflow/cloths.hpp>
#include <loomlink/workflow/validation.hpp>
#include <string>
#include <vector>

namespace weave::loomlink {

/// The feeders of a loom (given from 1) for those of a design. Errors: not one for each, or one that the loom
/// does not have.
Result<FeederMap> feeder_map(const weave::Design& design, const LoomProfile& profile,
                             const std::vector<std::int64_t>& feeders);

/// The name that a revision's files have: the design's and the revision's number.
std::string release_stem(const std::string& design, std::int64_t revision);

/// The files of a release, each read back by the decoders of libweave, which share no code with the writers.
Result<ReleasePackage> proven_package(const RevisionCloth& cloth, const LoomProfile& profile,
                                      const FeederMap& feeders, const std::string& stem);

/// What the package of a release does not know of itself.
struct ManifestTerms {
    std::string site, loom, design;
    std::uint64_t number = 0;
    Instant released;
};
/// The manifest for people to sign. Errors: what a terminal would refuse to read.
Result<ReleaseManifest> manifest_of(const ManifestTerms& terms, const Revision& revision,
                                    const ProfileInForce& profile, const ReleasePackage& package);

}  // namespace weave::loomlink
