#include <loomlink/workflow/cloths.hpp>

#include <weave/design/document.hpp>
#include <weave/picture/encode_png.hpp>

#include <algorithm>

namespace weave::loomlink {

namespace {

constexpr std::size_t most_kept = 4;
/// 1 GiB of cells for one document: a full shoe takes a part of it, and several can be woven at a time.
constexpr std::size_t weaving_limit = std::size_t{1} << 28;
constexpr std::size_t most_tile_pixels = 1024, most_scale = 65536;
constexpr std::uint32_t lifted_grey = 0x22, woven_grey = 0xf4;

/// Share of lifted ends among those below one pixel, by at most 8 by 8 of them.
std::uint32_t pixel(const CardImage& card, const CardTile& tile, std::size_t column, std::size_t row) {
    constexpr std::size_t most_samples = 8;
    const std::size_t x0 = tile.x + column * tile.scale, y0 = tile.y + row * tile.scale;
    const std::size_t x1 = std::min(x0 + tile.scale, tile.x + tile.width);
    const std::size_t y1 = std::min(y0 + tile.scale, tile.y + tile.height);
    const std::size_t step = std::max<std::size_t>(1, tile.scale / most_samples);
    std::size_t lifted = 0, all = 0;
    for (std::size_t y = y0; y < y1; y += step)
        for (std::size_t x = x0; x < x1; x += step, ++all)
            if (!card.weft_over(card.picks() - 1 - y, x)) ++lifted;
    const auto grey = static_cast<std::uint32_t>(woven_grey - (woven_grey - lifted_grey) * lifted /
                                                                  std::max<std::size_t>(all, 1));
    return grey << 16 | grey << 8 | grey;
}

}  // namespace

Result<RevisionClothPtr> weave_document(std::string_view text) {
    if (text.size() > most_document_bytes)
        return bad_input("has more than " + std::to_string(most_document_bytes >> 20) + " MiB", "document");
    auto cloth = std::make_shared<RevisionCloth>();
    WEAVE_TRY(cloth->design, read_document(text));
    Evaluator evaluator(0, weaving_limit);
    WEAVE_TRY(cloth->evaluation, evaluator.evaluate(cloth->design));
    cloth->card = cloth->evaluation.block->card_image();
    cloth->picks = pick_table(cloth->design, *cloth->evaluation.block);
    return RevisionClothPtr(std::move(cloth));
}

RevisionClothPtr ClothShelf::kept(const Hash& document) {
    const std::lock_guard lock(m_mutex);
    const auto place = std::find_if(m_kept.begin(), m_kept.end(),
                                    [&](const auto& entry) { return entry.first == document; });
    if (place == m_kept.end()) return nullptr;
    m_kept.splice(m_kept.begin(), m_kept, place);
    return m_kept.front().second;
}

void ClothShelf::keep(const Hash& document, RevisionClothPtr cloth) {
    const std::lock_guard lock(m_mutex);
    m_kept.emplace_front(document, std::move(cloth));
    if (m_kept.size() > most_kept) m_kept.pop_back();
}

Result<RevisionClothPtr> ClothShelf::find(const Reader& reader, const Hash& document) {
    if (auto known = kept(document)) return known;
    WEAVE_TRY(const auto text, reader.object(document));
    if (!text) return system_fault("the store is damaged: a document is missing");
    WEAVE_TRY(RevisionClothPtr cloth, weave_document(*text));
    keep(document, cloth);
    return cloth;
}

Result<std::string> draw_tile(const CardImage& card, const CardTile& tile) {
    if (tile.scale == 0 || tile.scale > most_scale || tile.width == 0 || tile.height == 0 ||
        tile.x >= card.ends() || tile.y >= card.picks() || tile.width > card.ends() - tile.x ||
        tile.height > card.picks() - tile.y)
        return bad_input("the card has " + std::to_string(card.ends()) + " ends and " +
                         std::to_string(card.picks()) + " picks: this part is not on it");
    const std::size_t wide = (tile.width + tile.scale - 1) / tile.scale;
    const std::size_t high = (tile.height + tile.scale - 1) / tile.scale;
    if (wide > most_tile_pixels || high > most_tile_pixels)
        return bad_input("a part has at most 1,024 pixels a side");
    std::vector<std::uint32_t> pixels(wide * high);
    for (std::size_t row = 0; row < high; ++row)
        for (std::size_t column = 0; column < wide; ++column)
            pixels[row * wide + column] = pixel(card, tile, column, row);
    return encode_png(pixels.data(), wide, high, wide);
}

}  // namespace weave::loomlink
