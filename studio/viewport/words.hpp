#pragma once

#include <weave/block/operations.hpp>
#include <studio/viewport/tube_model.hpp>

#include <QString>

namespace weave::studio {

/// "end 12 · beam 1" or "pick 7", counted from 1.
QString yarn_words(const TubeModel& model, std::uint32_t yarn, const Vec3& place);
/// What the face of a block is called on the orientation cube: "Face", "Back", "Pick 1" …
QString face_name(Face face);
/// What a click on it means: "attach here: after the last pick (+x)".
QString attach_words(Face face);
/// "yarn", "strain" …
QString colour_name(ColourBy colour);
/// With its unit, as over a colour scale: "strain, %"; empty where yarns have colours of their own.
QString scale_title(ColourBy colour);
QString view_name(StandardView view);

}  // namespace weave::studio
