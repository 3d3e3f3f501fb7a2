#include <studio/commands/set_scene.hpp>

#include <QCoreApplication>

namespace weave::studio {

namespace {

QString what_differs(const Scene& before, const Scene& scene) {
    if (before.warp != scene.warp) return QCoreApplication::translate("commands", "Change how the warp behaves");
    if (before.weft != scene.weft) return QCoreApplication::translate("commands", "Change how the weft behaves");
    if (before.weft_mode != scene.weft_mode) return QCoreApplication::translate("commands", "Change how the weft turns");
    if (before.friction != scene.friction) return QCoreApplication::translate("commands", "Change the friction");
    return QCoreApplication::translate("commands", "Change how the cloth is simulated");
}

}  // namespace

EditStep set_scene(const Scene& before, const Scene& scene, bool is_dragging) {
    return {what_differs(before, scene), {SetScene{scene}}, is_dragging ? "scene" : ""};
}

}  // namespace weave::studio
