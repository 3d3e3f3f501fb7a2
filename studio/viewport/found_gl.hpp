#pragma once

#include <QString>
#include <QSurfaceFormat>

namespace weave::studio {

/// What OpenGL there is on this display.
struct FoundGl {
    QString trouble;           ///< why the 3D view cannot be drawn, in a few words; empty where it can
    bool is_software = false;  ///< whether the processor draws
};

/// The OpenGL that the 3D view is written for.
QSurfaceFormat wanted_gl();

/// Tries OpenGL once in the run of the program, in a moment's context of its own.
const FoundGl& found_gl();

/// Whether a renderer, as OpenGL names it, is a program of the processor.
bool is_software_renderer(const QString& name);

}  // namespace weave::studio
