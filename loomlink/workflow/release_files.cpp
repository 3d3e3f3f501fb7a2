#include <weave/core/sha256.hpp>
#include <weave/io/controller_file.hpp>

#include <loomlink/workflow/release_files.hpp>

namespace weave::loomlink {

namespace {

std::vector<std::vector<std::size_t>> feeders_of(const ControllerCard& card) {
    std::vector<std::vector<std::size_t>> feeders(card.card.picks());
    for (std::size_t pick = 0; pick < card.feeders.size() && pick < feeders.size(); ++pick)
        feeders[pick].assign(card.feeders[pick].begin(), card.feeders[pick].end());
    return feeders;
}

/// A controller's file as libweave reads it: hooks and picks as woven.
Result<DecodedFile> decode(std::string_view bytes, const LoomProfile& profile, std::size_t ends) {
    WEAVE_TRY(const weave::ControllerFile file, read_controller_file(bytes, profile));
    WEAVE_TRY(const ControllerCard card, card_of(file, profile, ends));
    DecodedFile decoded;
    decoded.name = file.name;
    decoded.lifts = LiftTable(file.picks(), file.lifts.hooks());
    for (std::size_t pick = 0; pick < file.picks(); ++pick)
        for (std::size_t hook = 0; hook < file.lifts.hooks(); ++hook)
            if (file.lifts.lifted(pick, hook)) decoded.lifts.lift(pick, hook);
    decoded.feeders = feeders_of(card);
    decoded.card = card.card;
    return decoded;
}

}  // namespace

Result<FeederMap> feeder_map(const weave::Design& design, const std::vector<std::int64_t>& feeders) {
    if (feeders.size() != design.weft.feeders.size())
        return bad_input("must name a feeder of the loom for each of the design's " +
                             std::to_string(design.weft.feeders.size()),
                         "feeders");
    constexpr std::int64_t most_feeders = 64;
    FeederMap map;
    for (std::size_t k = 0; k < feeders.size(); ++k) {
        if (feeders[k] < 1 || feeders[k] > most_feeders) return bad_input("counts from 1", "feeders");
        map[static_cast<std::uint32_t>(k)] = static_cast<std::size_t>(feeders[k] - 1);
    }
    return map;
}

Result<ReleasePackage> proven_package(const RevisionCloth& cloth, const LoomProfile& profile,
                                      const FeederMap& feeders, const std::string& stem) {
    ReleaseNames names;
    names.stem = stem;
    names.in_file.name = stem;
    names.in_file.comment = stem;
    return make_release_package(cloth.design, cloth.evaluation, profile, feeders, names, {ExtraFile::wif},
                                decode);
}

ReleaseManifest manifest_of(const ManifestTerms& terms, const Revision& revision, const RevisionCloth& cloth,
                            const ProfileInForce& profile, const ReleasePackage& package) {
    ReleaseManifest manifest;
    manifest.site = terms.site;
    manifest.loom = terms.loom;
    manifest.release = terms.number;
    manifest.released = terms.released;
    manifest.design = terms.design;
    manifest.revision = static_cast<std::uint64_t>(revision.number);
    manifest.revision_sha256 = hash_hex(revision.hash);
    manifest.design_sha256 = hash_hex(revision.design_sha256);
    manifest.scene_sha256 = hash_hex(revision.scene_sha256);
    manifest.card_sha256 = hash_hex(revision.card_sha256);
    manifest.profile_name = profile.profile.name;
    manifest.profile_revision = profile.profile.version;
    manifest.profile_sha256 = profile.profile.sha256;
    manifest.profile_version = static_cast<std::uint64_t>(profile.version);
    manifest.picks = cloth.card.picks();
    manifest.ends = cloth.card.ends();
    manifest.reading = package.manifest;
    manifest.feeders = package.manifest.at("feeders").at("map");
    for (std::size_t k = 0; k < package.files.size(); ++k) {
        const PackageFile& file = package.files[k];
        const Json& said = package.manifest.at("files")[k];
        manifest.files.push_back({file.path, file.bytes.size(), sha256_hex(file.bytes), file.format,
                                  said.at("certified"), said.at("label")});
    }
    return manifest;
}

}  // namespace weave::loomlink
