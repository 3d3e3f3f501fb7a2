#pragma once

#include <weave/core/result.hpp>
#include <weave/design/design.hpp>

#include <studio/document/edit_step.hpp>

#include <string>
#include <cstddef>

namespace weave::studio {

/// `block` so many times along the picks' order (x), along the ends' (y) and in height (z), as a new block whose name `name`
/// is told. Errors: as `compose_blocks`.
Result<EditStep> tile_block(const Design& design, const std::string& block, std::size_t x, std::size_t y,
                            std::size_t z, std::string& name);

}  // namespace weave::studio
