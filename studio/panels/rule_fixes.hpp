#pragma once

#include <QString>

#include <string>

namespace weave::studio {

/// What a designer can do about a finding of this rule, one or two sentences; empty for an unknown rule.
QString fix_for(const std::string& rule);

}  // namespace weave::studio
