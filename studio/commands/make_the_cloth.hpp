#pragma once


#include <studio/document/edit_step.hpp>

#include <string>

namespace weave::studio {

/// This block is the cloth from now on.
EditStep make_the_cloth(const std::string& name);

}  // namespace weave::studio
