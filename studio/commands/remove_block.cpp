#include <studio/commands/remove_block.hpp>

#include <QCoreApplication>

namespace weave::studio {

EditStep remove_block(const std::string& name) {
    return {QCoreApplication::translate("commands", "Remove %1").arg(QString::fromStdString(name)), {RemoveBlock{name}}};
}

}  // namespace weave::studio
