#include <studio/commands/set_up.hpp>

#include <QCoreApplication>

namespace weave::studio {

EditStep set_scene(const Scene& scene, bool is_dragging) {
    return {QCoreApplication::translate("commands", "Change the simulation's scene"), {SetScene{scene}}, is_dragging ? "scene" : ""};
}

EditStep set_warp(const WarpPlan& warp, bool is_dragging) {
    return {QCoreApplication::translate("commands", "Change the warp"), {SetWarp{warp}}, is_dragging ? "warp" : ""};
}

EditStep set_weft(const WeftPlan& weft, bool is_dragging) {
    return {QCoreApplication::translate("commands", "Change the weft"), {SetWeft{weft}}, is_dragging ? "weft" : ""};
}

EditStep set_title(const std::string& title, const std::string& notes) {
    return {QCoreApplication::translate("commands", "Change title and notes"), {SetTitle{title, notes}}};
}

}  // namespace weave::studio
