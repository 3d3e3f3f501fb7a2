#pragma once

#include <weave/design/design.hpp>

#include <studio/document/edit_step.hpp>

#include <string>

namespace weave::studio {

/// A copy of a block, with its flips. `name` is told what it is called.
EditStep duplicate_block(const Design& design, const std::string& block, std::string& name);

}  // namespace weave::studio
