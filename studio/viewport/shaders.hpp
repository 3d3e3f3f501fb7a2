#pragma once

#include <QByteArray>

#include <initializer_list>

namespace weave::studio::shaders {

/// The sources of the viewer's programs; `defined` names switch parts of them on. In front of each stands the
/// version, GLSL 3.30.
///
/// First every piece of yarn is a rectangle, in whose pixels the ray of sight is cut with the piece: the
/// picture then holds which piece is seen and how far away (vertex, find). Then each pixel is lit once
/// (whole, light). Names: PLANES, pieces are cut, by the ends of their yarns or the clipping plane; MARKED,
/// yarns are emphasised; HOLLOWS, light is kept from where other yarns stand in its way.
QByteArray vertex(std::initializer_list<const char*> defined);
QByteArray find(std::initializer_list<const char*> defined);
QByteArray whole(std::initializer_list<const char*> defined);
QByteArray light(std::initializer_list<const char*> defined);

}  // namespace weave::studio::shaders
