#include <weave/block/card_image.hpp>
#include <weave/core/sha256.hpp>

namespace weave {

CardImage::CardImage(std::size_t picks, std::size_t ends)
    : m_picks(picks), m_ends(ends), m_row_bytes((ends + 7) / 8), m_bytes(picks * m_row_bytes) {}

std::string CardImage::sha256() const {
    return sha256_hex({reinterpret_cast<const char*>(m_bytes.data()), m_bytes.size()});
}

CardImage CardImage::transposed() const {
    CardImage turned(m_ends, m_picks);
    for (std::size_t pick = 0; pick < m_picks; ++pick) {
        for (std::size_t end = 0; end < m_ends; ++end) {
            if (weft_over(pick, end)) turned.set(end, pick, true);
        }
    }
    return turned;
}

Status check_card_size(std::uint64_t picks, std::uint64_t ends) {
    if (picks == 0 || ends == 0) return bad_input("a card image needs at least one pick and one end");
    if (picks > most_crossings / ends) {
        return bad_input("a card image of " + std::to_string(picks) + " picks and " + std::to_string(ends) +
                         " ends is larger than the limit of " + std::to_string(most_crossings) +
                         " crossings");
    }
    return {};
}

}  // namespace weave
