#pragma once

#include <weave/keys/key.hpp>

#include <filesystem>
#include <loomlink/store/store.hpp>
#include <vector>

namespace weave::loomlink {

/// Whose signatures count for verify_store(), by what the store itself says: statements by the keys of people
/// and machines in it, revoked ones too, since they counted once; heads by the keys of the log in its trust
/// documents and by `log`, the key that the site has now. Whoever holds the whole store can change that too;
/// only a retained head shows it. Reads the file and changes nothing, also while it is in use.
Result<StoreTrust> own_trust(const std::string& store, const PublicKey& log);

/// Every signature beside those of the log: on manifests of releases, on evidence, and the chain of trust
/// documents. Empty: all well.
Result<std::vector<AuditFinding>> verify_signatures(const std::string& store);

}  // namespace weave::loomlink
