#pragma once

#include <weave/core/result.hpp>
#include <weave/design/design.hpp>

#include <studio/document/edit_step.hpp>

#include <string>

namespace weave::studio {

/// A new block made by an operation from others of the design. Where it is made from the cloth itself (`grows` names the root)
/// it becomes the cloth, whose warp is so much denser that it stays as wide as it was. `name` is told what the new block is called. Errors: what the counts of the blocks do not allow, in
/// the library's words.
Result<EditStep> compose_blocks(const Design& design, const std::string& grows, const std::string& wish,
                                NodeSource operation, std::string& name);

}  // namespace weave::studio
