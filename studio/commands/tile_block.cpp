#include <studio/commands/tile_block.hpp>

#include <studio/commands/compose_blocks.hpp>

#include <QCoreApplication>

namespace weave::studio {

Result<EditStep> tile_block(const Design& design, const std::string& block, std::size_t x, std::size_t y,
                            std::size_t z, std::string& name) {
    WEAVE_TRY(EditStep step,
              compose_blocks(design, block, block + "-repeated", TileOperation{block, x, y, z}, name));
    step.text = QCoreApplication::translate("commands", "Repeat %1").arg(QString::fromStdString(block));
    return step;
}

}  // namespace weave::studio
