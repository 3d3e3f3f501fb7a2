// JC5 (Stäubli), as observed. Every number is big-endian.

#include <weave/core/text.hpp>

#include <algorithm>
#include <limits>
#include <loomlink/export/file_parts.hpp>
#include <loomlink/export/records.hpp>

namespace weave::loomlink {

namespace {

constexpr std::string_view magic = "\x81\xFE\x01\x01";
constexpr std::size_t longest_comment = 255;
constexpr std::uint32_t tag_name = 1, tag_picks = 2, tag_unknown = 6, tag_comment = 8, tag_area = 0x64;

void put_attribute(std::string& out, std::uint32_t tag, const std::string& value) {
    put_big32(out, tag);
    put_big32(out, static_cast<std::uint32_t>(value.size()));
    out += value;
}

std::string number(std::size_t value) {
    std::string bytes;
    put_big32(bytes, static_cast<std::uint32_t>(value));
    return bytes;
}

std::string ended(std::string text) {
    text.push_back('\0');
    return text;
}

std::string area_value(const HookArea& area) {
    constexpr std::size_t unknown_one = 1;  // unknown; 1 in every area of every file seen
    return number(unknown_one) + number(area.hooks) + ended(area.name);
}

Status check_limits(const HookPlan& plan, const LoomProfile& profile, const InFileNames& names) {
    if (profile.function_bytes > 0)
        return invalid("a JC5 file has no function bytes: feeders are selected by hooks of its areas");
    if (profile.feeder_encoding == FeederEncoding::one_hot ||
        profile.feeder_encoding == FeederEncoding::binary)
        return invalid("a JC5 file has no function bits: the profile's feeders must be hooks");
    if (plan.lifts.picks() > std::numeric_limits<std::uint32_t>::max())
        return invalid("a JC5 file cannot count " + counted(plan.lifts.picks(), "pick"));
    if (names.comment.size() > longest_comment || !is_printable(names.comment))
        return invalid("the comment of a JC5 file may have at most " + std::to_string(longest_comment) +
                       " characters, letters, digits and signs of ASCII only");
    for (const HookArea& area : profile.areas) {
        if (!is_printable(area.name))
            return invalid("the name of area '" + on_one_line(area.name) +
                           "' has characters that a JC5 file cannot hold");
    }
    return {};
}

}  // namespace

Result<WrittenFile> write_jc5(const HookPlan& plan, const LoomProfile& profile, const InFileNames& names) {
    WEAVE_CHECK_OK(check_limits(plan, profile, names));
    WEAVE_TRY(const FittedName name, fit_name(names.name, profile));
    WEAVE_TRY(const RecordLayout layout, record_layout(profile));
    WrittenFile file;
    file.names = {name.name, without_filling(names.comment)}, file.name_cut = name.cut;
    std::string field = name.name;
    field.resize(name_room, '\0');
    file.bytes = magic;
    put_big32(file.bytes, 4);  // attributes that follow
    put_attribute(file.bytes, tag_name, ended(field));
    put_attribute(file.bytes, tag_picks, number(plan.lifts.picks()));
    put_attribute(file.bytes, tag_unknown, number(0));  // unknown; 0 in every file seen
    put_attribute(file.bytes, tag_comment, ended(file.names.comment));
    put_big32(file.bytes, static_cast<std::uint32_t>(profile.areas.size()));
    for (const HookArea& area : profile.areas) put_attribute(file.bytes, tag_area, area_value(area));
    file.bytes += records(plan, profile, layout);
    file.unknown_fields = {"attribute 6: 0", "first number of each area: 1"};
    file.assumed = {"1 lifts, and the first record is pick 1, unless the profile says otherwise"};
    if (profile.feeders > 1 && profile.feeder_encoding != FeederEncoding::none)
        file.assumed.emplace_back(
            "more than one feeder: files seen had 01 00 00 00 in the function area throughout");
    note_settings(file, plan, profile);
    return file;
}

}  // namespace weave::loomlink
