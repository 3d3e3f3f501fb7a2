#include <studio/viewport/found_gl.hpp>

#include <QCoreApplication>
#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLFunctions>

#include <algorithm>
#include <array>

namespace weave::studio {

namespace {

FoundGl find_gl() {
    QOpenGLContext context;
    context.setFormat(wanted_gl());
    if (!context.create()) return {QCoreApplication::translate("ViewerPanel", "this display has no OpenGL"), false};
    QOffscreenSurface surface;
    surface.setFormat(context.format());
    surface.create();
    if (!context.makeCurrent(&surface)) return {QCoreApplication::translate("ViewerPanel", "OpenGL does not start on this display"), false};
    const auto version = context.format().version();
    if (version < std::pair(3, 3))
        return {QCoreApplication::translate("ViewerPanel", "this display has OpenGL %1.%2, and 3.3 is needed").arg(version.first).arg(version.second), false};
    return {{}, is_software_renderer(QString::fromUtf8(reinterpret_cast<const char*>(context.functions()->glGetString(GL_RENDERER))))};
}

}  // namespace

QSurfaceFormat wanted_gl() {
    QSurfaceFormat format;
    format.setVersion(3, 3);
    format.setProfile(QSurfaceFormat::CoreProfile);
    format.setDepthBufferSize(24);
    return format;
}

const FoundGl& found_gl() {
    static const FoundGl found = find_gl();
    return found;
}

bool is_software_renderer(const QString& name) {
    constexpr std::array names{"llvmpipe", "softpipe", "SWR", "SwiftShader", "GDI Generic"};
    return std::any_of(names.begin(), names.end(), [&](const char* one) { return name.contains(QLatin1String(one)); });
}

}  // namespace weave::studio
