#include <studio/commands/make_the_cloth.hpp>

#include <QCoreApplication>

namespace weave::studio {

EditStep make_the_cloth(const std::string& name) {
    return {QCoreApplication::translate("commands", "Make %1 the cloth").arg(QString::fromStdString(name)), {SetRoot{name}}};
}

}  // namespace weave::studio
