#pragma once

#include <weave/design/design.hpp>

#include <QString>

#include <string>
#include <studio/editors/coloured_picture.hpp>
#include <vector>

class QWidget;

namespace weave::studio {

/// Asks whether a picture in colours, which is no card, is to be a stencil, and which weave each of its colours stands for. Empty: the
/// person gave up.
std::vector<std::string> ask_weaves(const ColouredPicture& picture, const QString& path, QWidget* window);

/// The design whose cloth is that stencil; its weaves are blocks, to be changed like any others.
Result<Design> stencil_of_picture(const ColouredPicture& picture, const std::vector<std::string>& weaves);

}  // namespace weave::studio
