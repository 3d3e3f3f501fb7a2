#pragma once

#include <loomlink/workflow/evidence.hpp>
#include <loomlink/workflow/validation.hpp>
#include <string>
#include <vector>

namespace weave::loomlink {

/// Evidence about a revision that has to be there before somebody may approve it, in words; empty: it is. Of
/// validations those count that hold it to the profile in force.
Result<std::vector<std::string>> missing_evidence(const Reader& reader, const Design& design,
                                                  const Revision& revision, const SitePolicy& policy);

/// What still stands between a revision and the loom, in words.
Result<std::vector<std::string>> missing_for_release(const Reader& reader, const Design& design,
                                                     const Revision& revision);

/// Why a validation does not count any more; empty: it does.
Result<std::string> why_stale(const Reader& reader, const Validation& validation);

/// The people who approved a revision.
Result<std::size_t> approvals_of(const Reader& reader, Id revision);

}  // namespace weave::loomlink
