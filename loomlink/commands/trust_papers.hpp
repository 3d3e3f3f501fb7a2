#pragma once

#include <weave/wire/mill_client.hpp>
#include <filesystem>
#include <loomlink/keys/trust.hpp>
#include <string>
#include <vector>

namespace weave::loomlink {

/// The texts of all trust documents of the server, oldest first. Nothing in them has been checked.
Result<std::vector<std::string>> trust_papers(wire::MillClient& client);

/// The newest one, sound in itself. Whether it is the right one is for the caller to know. Error (refused):
/// there is none yet.
Result<TrustDocument> newest_trust_of(wire::MillClient& client);

/// The document of a file, as `trust show -o` wrote it, held to the fingerprint that an administrator told another way:
/// anybody can write one that is sound in itself. Errors: `invalid` for one that its people have not signed so, or with
/// another fingerprint.
Result<TrustDocument> trust_from_file(const std::filesystem::path& file, const std::string& fingerprint);

}  // namespace weave::loomlink
