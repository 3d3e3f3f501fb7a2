#include <studio/commands/rename_block.hpp>

#include <QCoreApplication>

namespace weave::studio {

EditStep rename_block(const std::string& from, const std::string& to) {
    return {QCoreApplication::translate("commands", "Rename %1 to %2").arg(QString::fromStdString(from), QString::fromStdString(to)),
            {RenameBlock{from, to}}};
}

}  // namespace weave::studio
