#pragma once

#include <weave/block/card_image.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/design/picks.hpp>

#include <cstddef>
#include <list>
#include <loomlink/store/reader.hpp>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace weave::loomlink {

/// A document as it was read and woven. Never changes.
struct RevisionCloth {
    weave::Design design;
    Evaluation evaluation;
    CardImage card;
    std::vector<Pick> picks;
};
using RevisionClothPtr = std::shared_ptr<const RevisionCloth>;

inline constexpr std::size_t most_document_bytes = std::size_t{64} << 20;

/// Reads and weaves a document from outside, within bounds of size and memory. Errors name the place in it.
Result<RevisionClothPtr> weave_document(std::string_view text);

/// The cloths that were looked at last, so that pages of a card are not woven anew for each tile. Safe to use
/// from any thread.
class ClothShelf {
  public:
    /// The cloth of a stored document.
    Result<RevisionClothPtr> find(const Reader& reader, const Hash& document);
    void keep(const Hash& document, RevisionClothPtr cloth);

  private:
    [[nodiscard]] RevisionClothPtr kept(const Hash& document);

    std::mutex m_mutex;
    std::list<std::pair<Hash, RevisionClothPtr>> m_kept;  ///< the one used last in front
};

/// A part of a card image as PNG, the last pick at the top: crossings from (x, y) at the top left, each pixel
/// `scale` of them wide and high. Errors: outside the card, or more pixels than a tile has.
struct CardTile {
    std::size_t x = 0, y = 0, width = 0, height = 0, scale = 1;
};
Result<std::string> draw_tile(const CardImage& card, const CardTile& tile);

}  // namespace weave::loomlink
