#pragma once

#include <weave/core/json.hpp>

#include <loomlink/audit/bundle.hpp>
#include <string>
#include <vector>

namespace weave::loomlink {

/// Findings in a log or a store: a list of `place`, `cause`, and `seq` where it is about one record.
Json findings_json(const std::vector<AuditFinding>& findings);

/// The same, a line each.
std::string findings_words(const std::vector<AuditFinding>& findings);

}  // namespace weave::loomlink
