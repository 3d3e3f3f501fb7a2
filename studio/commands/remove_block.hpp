#pragma once


#include <studio/document/edit_step.hpp>

#include <string>

namespace weave::studio {

/// A block that is still used stays: the error comes when the step is performed.
EditStep remove_block(const std::string& name);

}  // namespace weave::studio
