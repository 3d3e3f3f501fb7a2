// EP (Bonas), as observed. Every number is little-endian.

#include <weave/core/text.hpp>

#include <loomlink/export/file_parts.hpp>
#include <loomlink/export/records.hpp>

namespace weave::loomlink {

namespace {

constexpr std::size_t most_u16 = 0xffff;
constexpr std::size_t block = 4096;   // bytes of data in a block
constexpr std::size_t before = 2;     // the number of blocks stands before the first
constexpr std::size_t in_first = 32;  // bytes of the first block that the header takes
constexpr std::size_t tail = 1022;    // zeros at the end

struct Counts {
    std::size_t picks = 0, hooks = 0, blocks = 0;
};

Result<Counts> count(const HookPlan& plan, const LoomProfile& profile, const RecordLayout& layout) {
    Counts counts{plan.lifts.picks(), plan.lifts.hooks(), 0};
    if (counts.picks > most_u16)
        return invalid("an EP file holds at most " + std::to_string(most_u16) + " picks, not " +
                       std::to_string(counts.picks));
    if (counts.hooks > most_u16)
        return invalid("an EP file holds at most " + std::to_string(most_u16) + " hooks, not " +
                       std::to_string(counts.hooks));
    const std::size_t record = profile.function_bytes + layout.bytes;
    counts.blocks = (in_first + counts.picks * record + block - 1) / block;
    if (counts.blocks > most_u16)
        return invalid("an EP file holds at most " + std::to_string(most_u16) + " blocks of " +
                       std::to_string(block) + " bytes; " + counted(counts.picks, "pick") + " of " +
                       std::to_string(record) + " bytes need " + std::to_string(counts.blocks));
    return counts;
}

std::string header(const Counts& counts, const LoomProfile& profile, std::string name) {
    name.resize(name_room, '\0');
    std::string out;
    put_little(out, static_cast<std::uint32_t>(counts.blocks), 2);
    put_little(out, 0, 1);  // 2: unknown; 0 in every file seen
    put_little(out, static_cast<std::uint32_t>(counts.picks), 2);
    put_little(out, 0, 1);  // 5: unknown; 0
    out += name;
    put_little(out, 0, 1);  // 14: unknown; 0
    put_little(out, static_cast<std::uint32_t>(profile.function_bytes), 1);
    out.append(15, '\0');      // 16 to 30: unknown; 0
    put_little(out, 0x12, 1);  // 31: unknown; 12 hex in every file seen
    put_little(out, static_cast<std::uint32_t>(counts.hooks), 2);
    return out;
}

}  // namespace

Result<WrittenFile> write_ep(const HookPlan& plan, const LoomProfile& profile, const InFileNames& names) {
    WEAVE_TRY(const FittedName name, fit_name(names.name, profile));
    WEAVE_TRY(const RecordLayout layout, record_layout(profile));
    WEAVE_TRY(const Counts counts, count(plan, profile, layout));
    WrittenFile file;
    file.names.name = name.name, file.name_cut = name.cut;
    file.bytes = header(counts, profile, name.name) + records(plan, profile, layout);
    file.bytes.resize(before + block * counts.blocks, '\xff');
    file.bytes.append(tail, '\0');
    file.unknown_fields = {"bytes 2, 5, 14 and 16 to 30: 0", "byte 31: 12 hex",
                           "FF after the last record, and 1022 zeros at the end"};
    if (profile.function_bytes != 4)
        file.assumed.emplace_back("function bytes other than the 4 of every file seen");
    if (profile.areas.size() > 1) file.assumed.emplace_back("several areas, of which the file does not tell");
    if (profile.feeder_encoding != FeederEncoding::one_hot)
        file.assumed.emplace_back("feeders selected otherwise than by one function bit each");
    note_settings(file, plan, profile);
    return file;
}

}  // namespace weave::loomlink
