#pragma once

#include <weave/design/design.hpp>

#include <studio/document/edit_step.hpp>

#include <string>

namespace weave::studio {

EditStep set_title(const std::string& title, const std::string& notes);

}  // namespace weave::studio
