#pragma once

#include <weave/core/result.hpp>
#include <weave/design/evaluate.hpp>

#include <QImage>
#include <QMetaType>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <studio/document/card_picture.hpp>
#include <vector>

namespace weave::studio {

/// What a block of the design has come to.
struct Cloth {
    std::uint64_t revision = 0;  ///< of the document that it was made from
    BlockPtr block;              ///< null where it could not be made
    std::vector<LostFlip> lost_flips;
    std::optional<Error> error;  ///< why there is none
    /// The cells, row by row, whose stacks differ from the block of this name that was told before; nothing where all may.
    std::optional<std::vector<std::size_t>> changed_cells;
    std::shared_ptr<const CardPicture> card;  ///< of the block that is shown; null of others
    QImage thumbnail;  ///< its face, small; null where there is no block
};

}  // namespace weave::studio

Q_DECLARE_METATYPE(weave::studio::Cloth)
