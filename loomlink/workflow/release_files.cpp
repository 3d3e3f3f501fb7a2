#include <loomlink/workflow/release_files.hpp>

#include <loomlink/export/signed_manifest.hpp>
#include <utility>

namespace weave::loomlink {

Result<FeederMap> feeder_map(const weave::Design& design, const LoomProfile& profile,
                             const std::vector<std::int64_t>& feeders) {
    if (feeders.size() != design.weft.feeders.size())
        return bad_input("must name a feeder of the loom for each of the design's " +
                             std::to_string(design.weft.feeders.size()),
                         "feeders");
    FeederMap map;
    for (std::size_t k = 0; k < feeders.size(); ++k) {
        if (feeders[k] < 1 || std::cmp_greater(feeders[k], profile.feeders))
            return bad_input("this loom has no feeder " + std::to_string(feeders[k]) + ", it has " +
                                 (profile.feeders == 1 ? "one" : "1 to " + std::to_string(profile.feeders)),
                             "feeders");
        map[static_cast<std::uint32_t>(k)] = static_cast<std::size_t>(feeders[k] - 1);
    }
    return map;
}

std::string release_stem(const std::string& design, std::int64_t revision) {
    return design + "-" + std::to_string(revision);
}

Result<ReleasePackage> proven_package(const RevisionCloth& cloth, const LoomProfile& profile,
                                      const FeederMap& feeders, const std::string& stem) {
    return make_release_package(cloth.design, cloth.evaluation, profile, feeders, {stem, {stem, stem}},
                                {ExtraFile::wif});
}

Result<ReleaseManifest> manifest_of(const ManifestTerms& terms, const Revision& revision,
                                    const ProfileInForce& profile, const ReleasePackage& package) {
    ReleaseManifest manifest;
    manifest.site = terms.site;
    manifest.loom = terms.loom;
    manifest.release = terms.number;
    manifest.released = terms.released;
    manifest.design = terms.design;
    manifest.revision = static_cast<std::uint64_t>(revision.number);
    manifest.revision_sha256 = hash_hex(revision.hash);
    manifest.profile_version = static_cast<std::uint64_t>(profile.version);
    return manifest_of(package, std::move(manifest));
}

}  // namespace weave::loomlink
