#pragma once

#include <weave/design/design.hpp>

#include <studio/document/edit_step.hpp>

#include <string>

namespace weave::studio {

/// A block made from something else than before, its flips kept.
EditStep change_block(const Design& design, const std::string& name, NodeSource source, const QString& text);

}  // namespace weave::studio
