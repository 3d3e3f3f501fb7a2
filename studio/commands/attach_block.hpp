#pragma once

#include <weave/core/result.hpp>
#include <weave/design/design.hpp>

#include <studio/document/edit_step.hpp>

#include <string>

namespace weave::studio {

/// `other` on a face of `block`, as a new block whose name `name` is told. Errors: as `compose_blocks`.
Result<EditStep> attach_block(const Design& design, const std::string& block, const std::string& other,
                              Face face, std::string& name);

}  // namespace weave::studio
