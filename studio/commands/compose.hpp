#pragma once

#include <weave/core/result.hpp>
#include <weave/design/design.hpp>

#include <string>
#include <studio/document/edit_step.hpp>

namespace weave::studio {

/// A new block made by an operation from others of the design. Where it is made from the cloth itself (`grows` names the root)
/// it becomes the cloth. `name` is told what the new block is called. Errors: what the counts of the blocks do not allow, in
/// the library's words.
Result<EditStep> compose(const Design& design, const std::string& grows, const std::string& wish, NodeSource operation, std::string& name);

/// `other` on a face of `block`.
Result<EditStep> attach_block(const Design& design, const std::string& block, const std::string& other, Face face, std::string& name);

/// `block` so many times along the picks' order (x), along the ends' (y) and in height (z).
Result<EditStep> tile_block(const Design& design, const std::string& block, std::size_t x, std::size_t y, std::size_t z, std::string& name);

}  // namespace weave::studio
