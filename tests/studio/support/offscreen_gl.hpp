#pragma once

#include <QOffscreenSurface>
#include <QOpenGLContext>

#include <catch2/catch.hpp>

namespace weave::studio::test {

/// OpenGL 3.3 without a window, current for as long as it lives.
struct OffscreenGl {
    QOpenGLContext context;
    QOffscreenSurface surface;

    OffscreenGl() {
        QSurfaceFormat format;
        format.setVersion(3, 3);
        format.setProfile(QSurfaceFormat::CoreProfile);
        context.setFormat(format);
        REQUIRE(context.create());
        surface.setFormat(context.format());
        surface.create();
        REQUIRE(context.makeCurrent(&surface));
    }
};

}  // namespace weave::studio::test
