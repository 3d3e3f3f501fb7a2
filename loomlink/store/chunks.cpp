#include <loomlink/store/chunks.hpp>

#include <algorithm>
#include <array>
#include <cstdint>

namespace weave::loomlink {

namespace {

/// One random number a byte value (splitmix64 from a fixed start).
constexpr std::array<std::uint64_t, 256> make_gear() {
    std::array<std::uint64_t, 256> gear{};
    std::uint64_t state = 0x77656176656c6f6f;
    for (auto& number : gear) {
        state += 0x9e3779b97f4a7c15;
        std::uint64_t z = state;
        z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
        z = (z ^ z >> 27) * 0x94d049bb133111eb;
        number = z ^ z >> 31;
    }
    return gear;
}
constexpr auto gear = make_gear();

// The hash's top bits have seen the last 64 bytes; two bits more than the usual size needs before it, two
// fewer behind.
constexpr std::uint64_t strict_mask = ~std::uint64_t{0} << (64 - 16);
constexpr std::uint64_t loose_mask = ~std::uint64_t{0} << (64 - 12);

std::size_t cut_of(std::string_view bytes) {
    const std::size_t end = std::min(bytes.size(), most_chunk);
    std::uint64_t hash = 0;
    for (std::size_t k = least_chunk; k < end; ++k) {
        hash = (hash << 1) + gear[static_cast<unsigned char>(bytes[k])];
        if ((hash & (k < usual_chunk ? strict_mask : loose_mask)) == 0) return k + 1;
    }
    return end;
}

}  // namespace

std::vector<std::string_view> cut_into_chunks(std::string_view bytes) {
    std::vector<std::string_view> chunks;
    while (!bytes.empty()) {
        const std::size_t cut = bytes.size() <= least_chunk ? bytes.size() : cut_of(bytes);
        chunks.push_back(bytes.substr(0, cut));
        bytes.remove_prefix(cut);
    }
    return chunks;
}

}  // namespace weave::loomlink
