#pragma once

#include <filesystem>
#include <loomlink/commands/site_folder.hpp>
#include <vector>

namespace weave::loomlink {

/// Whether everything in the folder of a site is as it was written: the store (verify_store() and
/// verify_signatures()), and the keys and the certificate beside it. `retained`: a head kept from earlier.
/// Changes nothing, also while the site is served. Error: there is no store.
Result<std::vector<AuditFinding>> verify_site(const SiteFolder& site,
                                              const std::optional<SignedTreeHead>& retained);

/// The same of a store elsewhere, with the keys in the folder, as before or after a move.
Result<std::vector<AuditFinding>> verify_site_in(const SiteFolder& site, const std::string& store,
                                                 const std::optional<SignedTreeHead>& retained);

/// Copies a site, served or not, into a new folder of mode 0700 that appears whole or not at all: the store, as a file
/// wherever it is, the server's keys and its certificate. Refused where `to` exists.
Status back_up_site(const SiteFolder& site, const std::filesystem::path& to);

/// Copies the server's keys and its certificate. One that is missing is left out, one that is there stays.
Status copy_keys(const SiteFolder& from, const SiteFolder& to);

}  // namespace weave::loomlink
