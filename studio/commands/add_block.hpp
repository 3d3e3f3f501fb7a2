#pragma once

#include <weave/design/design.hpp>

#include <studio/document/edit_step.hpp>

#include <string>

namespace weave::studio {

/// A new block under a name that is free, `wish` if it can be. `name` is told it.
EditStep add_block(const Design& design, const std::string& wish, NodeSource source, std::string& name);

}  // namespace weave::studio
