#include <studio/commands/set_warp.hpp>

#include <QCoreApplication>

namespace weave::studio {

EditStep set_warp(const WarpPlan& warp, bool is_dragging) {
    return {QCoreApplication::translate("commands", "Change the warp"), {SetWarp{warp}}, is_dragging ? "warp" : ""};
}

}  // namespace weave::studio
