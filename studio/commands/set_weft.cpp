#include <studio/commands/set_weft.hpp>

#include <QCoreApplication>

namespace weave::studio {

EditStep set_weft(const WeftPlan& weft, bool is_dragging) {
    return {QCoreApplication::translate("commands", "Change the weft"), {SetWeft{weft}}, is_dragging ? "weft" : ""};
}

}  // namespace weave::studio
