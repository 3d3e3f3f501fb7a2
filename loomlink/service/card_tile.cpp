#include <weave/picture/encode_png.hpp>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <loomlink/service/card_tile.hpp>
#include <vector>

namespace weave::loomlink {

namespace {

/// How many of the bits from `from` up to `to` (not included) are 1; most significant bit first.
std::size_t ones_between(std::span<const std::uint8_t> row, std::size_t from, std::size_t to) {
    if (from >= to) return 0;
    const std::size_t first = from / 8, last = (to - 1) / 8;
    const auto head = static_cast<std::uint8_t>(0xff >> from % 8);
    const auto tail = static_cast<std::uint8_t>(0xff << (7 - (to - 1) % 8));
    if (first == last) return static_cast<std::size_t>(std::popcount(std::uint8_t(row[first] & head & tail)));
    std::size_t count = static_cast<std::size_t>(std::popcount(std::uint8_t(row[first] & head))) +
                        static_cast<std::size_t>(std::popcount(std::uint8_t(row[last] & tail)));
    for (std::size_t k = first + 1; k < last; ++k) count += static_cast<std::size_t>(std::popcount(row[k]));
    return count;
}

Status check_part(const CardImage& card, const CardPart& part) {
    if (part.width == 0 || part.height == 0 || part.scale == 0)
        return bad_input("a part of the card has at least one crossing", "w");
    if (part.x >= card.ends() || part.width > card.ends() - part.x)
        return bad_input("reaches beyond the card's " + std::to_string(card.ends()) + " ends", "x");
    if (part.y >= card.picks() || part.height > card.picks() - part.y)
        return bad_input("reaches beyond the card's " + std::to_string(card.picks()) + " picks", "y");
    const std::size_t longest = (std::max(part.width, part.height) - 1) / part.scale + 1;
    if (longest > longest_tile_side)
        return bad_input("a tile has at most " + std::to_string(longest_tile_side) + " pixels a side",
                         "scale");
    return {};
}

}  // namespace

Result<std::string> draw_card_part(const CardImage& card, const CardPart& part) {
    WEAVE_CHECK_OK(check_part(card, part));
    const std::size_t wide = (part.width - 1) / part.scale + 1, high = (part.height - 1) / part.scale + 1;
    std::vector<std::uint32_t> pixels(wide * high);
    std::vector<std::size_t> ones(wide);
    for (std::size_t y = 0; y < high; ++y) {
        std::fill(ones.begin(), ones.end(), 0);
        const std::size_t top = part.y + y * part.scale;
        const std::size_t bottom = std::min(top + part.scale, part.y + part.height);
        for (std::size_t line = top; line < bottom; ++line) {
            const auto row = card.row(card.picks() - 1 - line);
            for (std::size_t x = 0; x < wide; ++x) {
                const std::size_t from = part.x + x * part.scale;
                ones[x] += ones_between(row, from, std::min(from + part.scale, part.x + part.width));
            }
        }
        for (std::size_t x = 0; x < wide; ++x) {
            const std::size_t columns = std::min(part.scale, part.width - x * part.scale);
            const auto grey = static_cast<std::uint32_t>(255 * ones[x] / (columns * (bottom - top)));
            pixels[y * wide + x] = grey * 0x010101;
        }
    }
    return encode_png(pixels.data(), wide, high, wide);
}

}  // namespace weave::loomlink
