#include <studio/commands/set_scene.hpp>

#include <QCoreApplication>

namespace weave::studio {

EditStep set_scene(const Scene& scene, bool is_dragging) {
    return {QCoreApplication::translate("commands", "Change the simulation's scene"), {SetScene{scene}}, is_dragging ? "scene" : ""};
}

}  // namespace weave::studio
