#include <studio/commands/duplicate_block.hpp>

#include <weave/design/merge.hpp>

#include <QCoreApplication>

namespace weave::studio {

EditStep duplicate_block(const Design& design, const std::string& block, std::string& name) {
    name = free_name(design, block);
    return {QCoreApplication::translate("commands", "Duplicate %1").arg(QString::fromStdString(block)),
            {PutBlock{name, design.blocks.at(block)}}};
}

}  // namespace weave::studio
