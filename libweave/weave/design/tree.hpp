#pragma once

#include <weave/design/design.hpp>

#include <map>
#include <string>
#include <vector>

namespace weave {

/// The blocks that `root` is made from, itself included and last, each after all that it is made from.
/// The design must pass check().
std::vector<std::string> bottom_up(const Design& design, const std::string& root);

/// The node made from other names: each child that `names` holds is exchanged. The node itself where none is.
NodePtr with_renamed_children(const NodePtr& node, const std::map<std::string, std::string>& names);

}  // namespace weave
