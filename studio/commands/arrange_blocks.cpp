#include <studio/commands/arrange_blocks.hpp>

#include <QCoreApplication>

namespace weave::studio {

namespace {

QString named(const std::string& name) {
    return QString::fromStdString(name);
}

}  // namespace

EditStep remove_block(const std::string& name) {
    return {QCoreApplication::translate("commands", "Remove %1").arg(named(name)), {RemoveBlock{name}}};
}

EditStep rename_block(const std::string& from, const std::string& to) {
    return {QCoreApplication::translate("commands", "Rename %1 to %2").arg(named(from), named(to)), {RenameBlock{from, to}}};
}

EditStep make_the_cloth(const std::string& name) {
    return {QCoreApplication::translate("commands", "Make %1 the cloth").arg(named(name)), {SetRoot{name}}};
}

}  // namespace weave::studio
