#pragma once

#include <weave/design/design.hpp>

#include <string>
#include <studio/document/edit_step.hpp>

namespace weave::studio {

/// Errors of these come when they are performed: a block that is still used, a name that is taken.
EditStep remove_block(const std::string& name);
EditStep rename_block(const std::string& from, const std::string& to);
/// This block is the cloth from now on.
EditStep make_the_cloth(const std::string& name);

}  // namespace weave::studio
