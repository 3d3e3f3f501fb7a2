#include <studio/commands/attach_block.hpp>

#include <studio/commands/compose_blocks.hpp>

#include <QCoreApplication>

namespace weave::studio {

Result<EditStep> attach_block(const Design& design, const std::string& block, const std::string& other,
                              Face face, std::string& name) {
    WEAVE_TRY(EditStep step, compose_blocks(design, block, block + "-with-" + other,
                                            AttachOperation{block, other, face}, name));
    step.text = QCoreApplication::translate("commands", "Attach %1 to %2")
                    .arg(QString::fromStdString(other), QString::fromStdString(block));
    return step;
}

}  // namespace weave::studio
