#include <weave/block/card_image.hpp>

#include <weave/core/sha256.hpp>

#include <algorithm>

namespace weave {

namespace {

/// Eight by eight bits with rows and columns exchanged: halves of 1, 2 and 4 lines swap across the diagonal.
std::uint64_t transposed_square(std::uint64_t bits) {
    const auto swap = [&](std::uint64_t mask, int distance) {
        const std::uint64_t change = (bits ^ bits >> distance) & mask;
        bits ^= change ^ change << distance;
    };
    swap(0x00aa00aa00aa00aa, 7);
    swap(0x0000cccc0000cccc, 14);
    swap(0x00000000f0f0f0f0, 28);
    return bits;
}

}  // namespace

CardImage::CardImage(std::size_t picks, std::size_t ends)
    : m_picks(picks), m_ends(ends), m_row_bytes((ends + 7) / 8), m_bytes(picks * m_row_bytes) {}

std::string CardImage::sha256() const {
    return sha256_hex({reinterpret_cast<const char*>(m_bytes.data()), m_bytes.size()});
}

CardImage CardImage::transposed() const {
    CardImage turned(m_ends, m_picks);
    for (std::size_t pick = 0; pick < m_picks; pick += 8) {
        const std::size_t picks_here = std::min<std::size_t>(8, m_picks - pick);
        for (std::size_t byte = 0; byte < m_row_bytes; ++byte) {
            std::uint64_t square = 0;  // eight picks of eight ends, first pick in the top byte
            for (std::size_t k = 0; k < picks_here; ++k) {
                square |= std::uint64_t{m_bytes[(pick + k) * m_row_bytes + byte]} << (56 - 8 * k);
            }
            square = transposed_square(square);
            const std::size_t ends_here = std::min<std::size_t>(8, m_ends - 8 * byte);
            for (std::size_t k = 0; k < ends_here; ++k) {
                turned.m_bytes[(8 * byte + k) * turned.m_row_bytes + pick / 8] =
                    static_cast<std::uint8_t>(square >> (56 - 8 * k) & 0xff);
            }
        }
    }
    return turned;
}

Status check_card_size(std::uint64_t picks, std::uint64_t ends) {
    if (picks == 0 || ends == 0) return bad_input("a card image needs at least one pick and one end");
    const std::string size =
        "a card image of " + std::to_string(picks) + " picks and " + std::to_string(ends) + " ends is larger than the limit of ";
    if (picks > most_yarns || ends > most_yarns) return bad_input(size + std::to_string(most_yarns) + " picks or ends");
    if (picks > most_crossings / ends) return bad_input(size + std::to_string(most_crossings) + " crossings");
    return {};
}

}  // namespace weave
