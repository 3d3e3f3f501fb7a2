#pragma once

#include <loomlink/export/package.hpp>
#include <loomlink/keys/release_manifest.hpp>

namespace weave::loomlink {

/// The manifest for the people to sign: `terms` with all that the package knows.
///  - hashes of design, scene and card, picks and ends, the profile's name, revision and hash, the files;
///  - `feeders`: the package's map, one entry a feeder of the design (`design_feeder`, `name`, `yarn`,
///    `loom_feeder`, from 1);
///  - `reading`: all else of the package's manifest (README.md beside this file), with how feeders are
///  encoded, and
///    under `files` by path how each file is to be read, which of its fields are unknown, and what no file
///    showed.
///
/// The caller fills in `terms` what the package does not know: site, loom, release, released, design,
/// revision, revision_sha256 and profile_version. Errors (`invalid`): a file name that a terminal refuses,
/// more files or bytes than a release may have, a manifest that is too long to be read again.
Result<ReleaseManifest> manifest_of(const ReleasePackage& package, ReleaseManifest terms);

}  // namespace weave::loomlink
