#pragma once


#include <studio/document/edit_step.hpp>

#include <string>

namespace weave::studio {

/// A block under another name, wherever it is used. A name that is taken is an error when the step is performed.
EditStep rename_block(const std::string& from, const std::string& to);

}  // namespace weave::studio
