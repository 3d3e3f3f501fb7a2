#pragma once

#include <weave/block/flip.hpp>
#include <weave/design/design.hpp>

#include <span>
#include <string>
#include <studio/document/edit_step.hpp>

namespace weave::studio {

/// Many flips of a block as one edit of it.
EditStep set_crossings(const Design& design, const std::string& block, std::span<const Flip> flips, const QString& text);

}  // namespace weave::studio
