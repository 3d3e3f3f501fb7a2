#include <studio/commands/set_title.hpp>

#include <QCoreApplication>

namespace weave::studio {

EditStep set_title(const std::string& title, const std::string& notes) {
    return {QCoreApplication::translate("commands", "Change title and notes"), {SetTitle{title, notes}}};
}

}  // namespace weave::studio
