#include <weave/core/text.hpp>
#include <weave/io/controller_reader.hpp>

#include <array>

namespace weave::controller {

namespace {

// Offsets and sizes as observed (CONTROLLER_FILES.md). Blocks count from byte 2 on: 32 bytes of header, then
// records.
constexpr std::size_t blocks_at = 0, picks_at = 3, name_at = 6, name_bytes = 8, function_bytes_at = 15,
                      hooks_at = 32;
constexpr std::size_t blocks_from = 2, header_bytes = 34, block_bytes = 4096, tail_bytes = 1022;

/// A byte of the header whose meaning is not known, and the value that it had in all files seen.
struct UnknownByte {
    std::size_t at = 0;
    std::uint8_t observed = 0;
};
constexpr std::array<UnknownByte, 19> unknown_bytes{{{2, 0},
                                                     {5, 0},
                                                     {14, 0},
                                                     {16, 0},
                                                     {17, 0},
                                                     {18, 0},
                                                     {19, 0},
                                                     {20, 0},
                                                     {21, 0},
                                                     {22, 0},
                                                     {23, 0},
                                                     {24, 0},
                                                     {25, 0},
                                                     {26, 0},
                                                     {27, 0},
                                                     {28, 0},
                                                     {29, 0},
                                                     {30, 0},
                                                     {31, 0x12}}};

struct Header {
    std::size_t blocks = 0, picks = 0, function_bytes = 0, hooks = 0;
    std::size_t record_bytes =
        0;  ///< function bytes and hooks; by the profile where areas fill bytes of their own

    [[nodiscard]] std::size_t records_end() const { return header_bytes + picks * record_bytes; }
    /// What the number of picks and the length of a record demand.
    [[nodiscard]] std::size_t blocks_needed() const {
        return (records_end() - blocks_from + block_bytes - 1) / block_bytes;
    }
    [[nodiscard]] std::size_t blocks_end() const { return blocks_from + blocks * block_bytes; }
    [[nodiscard]] std::size_t file_bytes() const { return blocks_end() + tail_bytes; }
};

Result<Header> read_header(std::string_view bytes) {
    if (bytes.size() < header_bytes) {
        return bad_input("the file ends within the header of " + std::to_string(header_bytes) + " bytes",
                         at_byte(bytes.size()));
    }
    Header header{little(bytes, blocks_at, 2), little(bytes, picks_at, 2), byte_at(bytes, function_bytes_at),
                  little(bytes, hooks_at, 2), 0};
    header.record_bytes = header.function_bytes + (header.hooks + 7) / 8;
    if (header.hooks == 0) return bad_input("the file says that it has 0 hooks", at_byte(hooks_at));
    if (header.picks == 0) return bad_input("the file says that it has no picks", at_byte(picks_at));
    return header;
}

/// The file is for the loom of the profile.
Status check_loom(const Header& header, const LoomProfile& profile) {
    if (header.function_bytes != profile.function_bytes) {
        return bad_input("says " + counted(header.function_bytes, "function byte") +
                             " a pick, but the profile of the loom " + std::to_string(profile.function_bytes),
                         at_byte(function_bytes_at));
    }
    if (header.hooks == profile.total_hooks) return {};
    return bad_input("the file is for " + counted(header.hooks, "hook") +
                         ", but the loom of the profile has " + std::to_string(profile.total_hooks),
                     at_byte(hooks_at));
}

Status check_sizes(const Header& header, std::size_t size) {
    if (header.blocks != header.blocks_needed()) {
        return bad_input("says " + counted(header.blocks, "block") + ", but " +
                             counted(header.picks, "pick") + " of " + counted(header.record_bytes, "byte") +
                             " need " + std::to_string(header.blocks_needed()),
                         at_byte(blocks_at));
    }
    if (size == header.file_bytes()) return {};
    return bad_input(counted(header.blocks, "block") + " make a file of " +
                         std::to_string(header.file_bytes()) + " bytes, but it has " + std::to_string(size),
                     at_byte(std::min(size, header.file_bytes())));
}

void check_unknown(std::string_view bytes, Oddities& oddities) {
    for (const UnknownByte& unknown : unknown_bytes) {
        if (byte_at(bytes, unknown.at) == unknown.observed) continue;
        const char observed = static_cast<char>(unknown.observed);
        oddities.add(unknown.at, "is " + hexadecimal(bytes.substr(unknown.at, 1)) + ", where " +
                                     hexadecimal({&observed, 1}) + " was observed; its meaning is not known");
    }
}

/// Padding from `begin` to `end`, all of which should be this byte.
void check_padding(std::string_view bytes, std::size_t begin, std::size_t end, char padding,
                   Oddities& oddities) {
    std::size_t others = 0, first = 0;
    for (std::size_t at = begin; at < end; ++at) {
        if (bytes[at] != padding && others++ == 0) first = at;
    }
    if (others == 0) return;
    oddities.add(first, "is " + hexadecimal(bytes.substr(first, 1)) + " in a padding of " +
                            hexadecimal({&padding, 1}) + "; " + counted(others, "byte") + " of it " +
                            (others == 1 ? "is" : "are") + " not as observed");
}

}  // namespace

bool looks_like_ep(std::string_view bytes) {
    const Result<Header> header = read_header(bytes);
    return header && header->function_bytes <= most_function_bytes && check_sizes(*header, bytes.size());
}

Result<ControllerFile> read_ep(std::string_view bytes, const LoomProfile& profile) {
    WEAVE_TRY(const HookLayout layout, hook_layout(profile));
    WEAVE_TRY(Header header, read_header(bytes));
    WEAVE_CHECK_OK(check_loom(header, profile));
    header.record_bytes = layout.bytes();
    WEAVE_CHECK_OK(check_sizes(header, bytes.size()));
    ControllerFile file;
    file.format = OutputFormat::ep;
    file.areas = {{"", header.hooks}};
    file.records_at = header_bytes;
    Oddities oddities;
    check_unknown(bytes, oddities);
    file.name = text_of(bytes.substr(name_at, name_bytes), name_at, "the name", oddities);
    check_padding(bytes, header.records_end(), header.blocks_end(), '\xff', oddities);
    check_padding(bytes, header.blocks_end(), header.file_bytes(), '\0', oddities);
    read_records(bytes, header.picks, profile, layout, file, oddities);
    file.warnings = std::move(oddities).take();
    return file;
}

}  // namespace weave::controller
