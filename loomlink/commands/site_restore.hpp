#pragma once

#include <filesystem>
#include <loomlink/commands/site_folder.hpp>
#include <optional>

namespace weave::loomlink {

/// Puts a backup into place, after verifying it; the folder may be missing, empty, or hold a site. What was its store stays
/// beside it as `loomlink.db.replaced`, which is the answer; nothing where there was none. Keys that are there stay, but for
/// those of another site, which are kept under such a name too. Refused: a backup with findings, a folder that is being served, a
/// name that is taken, and, unless `may_replace`, a site whose log has records that the backup has not.
Result<std::optional<std::filesystem::path>> restore_site(const SiteFolder& backup, const SiteFolder& to, bool may_replace);

}  // namespace weave::loomlink
