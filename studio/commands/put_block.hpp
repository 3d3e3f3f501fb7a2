#pragma once

#include <weave/design/design.hpp>

#include <QString>

#include <string>
#include <studio/document/edit_step.hpp>

namespace weave::studio {

/// A block made from something else than before, its flips kept.
EditStep change_block(const Design& design, const std::string& name, NodeSource source, const QString& text);

/// A new block under a name that is free, `wish` if it can be. `name` is told it.
EditStep add_block(const Design& design, const std::string& wish, NodeSource source, std::string& name);

/// A copy of a block, with its flips.
EditStep duplicate_block(const Design& design, const std::string& block, std::string& name);

}  // namespace weave::studio
