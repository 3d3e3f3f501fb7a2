// PNG files from anywhere, as cards and as stencils. Every chunk ends in a checksum and the pixels are
// compressed, so blind changes would hardly get past libpng's door: the mutator below changes the pixels
// themselves at times, and always puts the checksums right.
#include "support/must.hpp"
#include "support/picture.hpp"

#include <algorithm>
#include <cstring>
#include <vector>
#include <zlib.h>

using Bytes = std::vector<std::uint8_t>;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

constexpr std::size_t signature_bytes = 8, chunk_bytes = 12;  // length, type and checksum of a chunk

std::uint32_t number_at(const std::uint8_t* at) {
    return std::uint32_t{at[0]} << 24 | std::uint32_t{at[1]} << 16 | std::uint32_t{at[2]} << 8 | at[3];
}

void put_number(std::uint8_t* at, std::uint32_t number) {
    for (int k = 0; k < 4; ++k) at[k] = static_cast<std::uint8_t>(number >> (24 - 8 * k));
}

/// Calls `visit(chunk, length)` for every whole chunk; `chunk` points at its length field. Stops where it
/// gives false.
template <class Visit>
void each_chunk(std::uint8_t* data, std::size_t size, Visit visit) {
    for (std::size_t at = signature_bytes; at + chunk_bytes <= size;) {
        const std::size_t length = number_at(data + at);
        if (length > size - at - chunk_bytes || !visit(data + at, length)) return;
        at += chunk_bytes + length;
    }
}

void put_checksums_right(std::uint8_t* data, std::size_t size) {
    each_chunk(data, size, [](std::uint8_t* chunk, std::size_t length) {
        put_number(chunk + 8 + length,
                   static_cast<std::uint32_t>(crc32(0, chunk + 4, static_cast<uInt>(length + 4))));
        return true;
    });
}

/// Unpacks the first IDAT chunk, changes its bytes and packs them again; the size of the file then, 0 where
/// that fails.
std::size_t mutate_pixels(std::uint8_t* data, std::size_t size, std::size_t most) {
    std::uint8_t* pixels = nullptr;
    std::size_t length = 0;
    each_chunk(data, size, [&](std::uint8_t* chunk, std::size_t bytes) {
        if (std::memcmp(chunk + 4, "IDAT", 4) != 0) return true;
        pixels = chunk;
        length = bytes;
        return false;
    });
    if (pixels == nullptr) return 0;
    Bytes raw(1 << 16);
    uLongf raw_size = raw.size() / 2;  // room for the change to grow
    if (uncompress(raw.data(), &raw_size, pixels + 8, length) != Z_OK) return 0;
    raw.resize(LLVMFuzzerMutate(raw.data(), raw_size, raw.size()));
    Bytes packed(compressBound(raw.size()));
    uLongf packed_size = packed.size();
    if (compress(packed.data(), &packed_size, raw.data(), raw.size()) != Z_OK) return 0;
    const Bytes tail(pixels + 8 + length, data + size);
    const std::size_t head = static_cast<std::size_t>(pixels - data) + 8;
    if (head + packed_size + tail.size() > most) return 0;
    put_number(pixels, static_cast<std::uint32_t>(packed_size));
    std::copy_n(packed.data(), packed_size, data + head);
    std::copy(tail.begin(), tail.end(), data + head + packed_size);
    return head + packed_size + tail.size();
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned seed) {
    std::size_t changed = seed % 4 == 0 ? mutate_pixels(data, size, most) : 0;
    if (changed == 0) changed = LLVMFuzzerMutate(data, size, most);
    if (seed % 16 != 1) put_checksums_right(data, changed);  // wrong ones deserve a visit as well
    return changed;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::uint64_t claimed = size < 24 ? 0 : std::uint64_t{number_at(data + 16)} * number_at(data + 20);
    weave::fuzz::try_picture(weave::fuzz::text_of(data, size), weave::BitmapFormat::png, claimed);
    return 0;
}
