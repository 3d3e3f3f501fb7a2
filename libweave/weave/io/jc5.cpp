#include <weave/core/text.hpp>
#include <weave/io/controller_reader.hpp>

#include <map>
#include <optional>

namespace weave::controller {

namespace {

// Tags and values as observed (CONTROLLER_FILES.md).
constexpr std::uint32_t name_tag = 1, picks_tag = 2, zero_tag = 6, comment_tag = 8, area_tag = 0x64;
constexpr std::uint32_t observed_attributes = 4, observed_name_bytes = 9, observed_area_kind = 1;
constexpr std::uint32_t most_attributes = 1000;
constexpr std::size_t area_numbers = 8;  // bytes of an area before its name

std::string tag_name(std::uint32_t tag) {
    return "attribute " + std::to_string(tag);
}

/// Goes through the file from its start; what is asked for lies within it, or an error says where it ends.
class Cursor {
  public:
    explicit Cursor(std::string_view bytes) : m_bytes(bytes) {}

    [[nodiscard]] std::size_t at() const { return m_at; }
    [[nodiscard]] std::size_t left() const { return m_bytes.size() - m_at; }

    Result<std::string_view> take(std::size_t count, const std::string& what) {
        if (count > left()) {
            return bad_input(what + " should have " + counted(count, "byte") + ", but the file has " +
                                 std::to_string(left()) + " left",
                             at_byte(m_at));
        }
        m_at += count;
        return m_bytes.substr(m_at - count, count);
    }

    Result<std::uint32_t> number(const std::string& what) {
        WEAVE_TRY(const std::string_view bytes, take(4, what));
        return big(bytes);
    }

    /// Four bytes, the first the highest.
    static std::uint32_t big(std::string_view bytes) {
        std::uint32_t value = 0;
        for (std::size_t k = 0; k < 4; ++k) value = value << 8 | byte_at(bytes, k);
        return value;
    }

  private:
    std::string_view m_bytes;
    std::size_t m_at = 0;
};

/// A tag with its value.
struct Field {
    std::uint32_t tag = 0;
    std::size_t tag_offset = 0, offset = 0;  ///< of the tag, of the value
    std::string_view value;
};

Result<Field> read_field(Cursor& cursor, const std::string& what) {
    Field field;
    field.tag_offset = cursor.at();
    WEAVE_TRY(field.tag, cursor.number("the tag of " + what));
    WEAVE_TRY(const std::uint32_t length, cursor.number("the length of " + what));
    field.offset = cursor.at();
    WEAVE_TRY(field.value, cursor.take(length, what));
    return field;
}

using Attributes = std::map<std::uint32_t, Field>;

Result<Attributes> read_attributes(Cursor& cursor, Oddities& oddities) {
    const std::size_t count_at = cursor.at();
    WEAVE_TRY(const std::uint32_t count, cursor.number("the number of attributes"));
    if (count != observed_attributes)
        oddities.add(count_at, "the file has " + counted(count, "attribute") + ", where 4 were observed");
    if (count > most_attributes) {
        return bad_input("says " + counted(count, "attribute") + "; more than " +
                             std::to_string(most_attributes) + " are not read",
                         at_byte(count_at));
    }
    Attributes attributes;
    for (std::uint32_t k = 0; k < count; ++k) {
        WEAVE_TRY(const Field field, read_field(cursor, "attribute number " + std::to_string(k + 1)));
        if (!attributes.empty() && field.tag < attributes.rbegin()->first) {
            oddities.add(field.tag_offset, tag_name(field.tag) + " comes after " +
                                               tag_name(attributes.rbegin()->first) +
                                               ", where it was observed before it");
        }
        if (!attributes.emplace(field.tag, field).second)
            return bad_input(tag_name(field.tag) + " comes twice", at_byte(field.tag_offset));
    }
    return attributes;
}

void check_zero(const Field& field, Oddities& oddities) {
    if (field.value == std::string_view("\0\0\0\0", 4)) return;
    oddities.add(field.offset, tag_name(zero_tag) + " is " + hexadecimal(field.value) +
                                   ", where 00 00 00 00 was observed; its meaning is not known");
}

std::string read_name(const Field& field, Oddities& oddities) {
    if (field.value.size() != observed_name_bytes) {
        oddities.add(field.offset, "the name has a field of " + counted(field.value.size(), "byte") +
                                       ", where 9 were observed");
    }
    if (!field.value.ends_with('\0')) oddities.add(field.offset, "the name does not end with NUL");
    return text_of(field.value, field.offset, "the name", oddities);
}

/// A text that ends with one NUL.
std::string ended_text(std::string_view value, std::size_t offset, const std::string& what,
                       Oddities& oddities) {
    if (!value.ends_with('\0')) {
        oddities.add(offset, what + " does not end with NUL");
    } else if (value.size() > 1 && value[value.size() - 2] == '\0') {
        oddities.add(offset, what + " ends with more than one NUL");
    }
    return text_of(value, offset, what, oddities);
}

/// The number of picks, and into `file` what else the attributes say.
Result<std::size_t> apply(const Attributes& attributes, std::size_t attributes_end, ControllerFile& file,
                          Oddities& oddities) {
    std::optional<std::size_t> picks;
    for (const auto& [tag, field] : attributes) {
        if (tag == name_tag) {
            file.name = read_name(field, oddities);
        } else if (tag == picks_tag) {
            if (field.value.size() != 4) {
                return bad_input(
                    "the number of picks has " + counted(field.value.size(), "byte") + " instead of 4",
                    at_byte(field.offset));
            }
            picks = Cursor::big(field.value);
            if (*picks == 0) return bad_input("the file says that it has no picks", at_byte(field.offset));
        } else if (tag == zero_tag) {
            check_zero(field, oddities);
        } else if (tag == comment_tag) {
            file.comment = ended_text(field.value, field.offset, "the comment", oddities);
        } else {
            oddities.add(field.tag_offset, tag_name(tag) +
                                               " is not known: " + counted(field.value.size(), "byte") +
                                               (field.value.empty() ? "" : ", " + hexadecimal(field.value)));
        }
    }
    if (!picks) return bad_input("attribute 2, the number of picks, is missing", at_byte(attributes_end));
    for (const std::uint32_t tag : {name_tag, zero_tag, comment_tag}) {
        if (!attributes.contains(tag))
            oddities.add(attributes_end, tag_name(tag) + " is missing, which was observed in all files");
    }
    return *picks;
}

Result<HookArea> read_area(const Field& field, const std::string& what, Oddities& oddities) {
    if (field.tag != area_tag) {
        return bad_input(what + " has tag " + std::to_string(field.tag) + " instead of 100",
                         at_byte(field.tag_offset));
    }
    if (field.value.size() < area_numbers) {
        return bad_input(
            what + " has " + counted(field.value.size(), "byte") + ", too few for its number of hooks",
            at_byte(field.offset));
    }
    if (const std::uint32_t kind = Cursor::big(field.value); kind != observed_area_kind) {
        oddities.add(field.offset, what + " starts with " + hexadecimal(field.value.substr(0, 4)) +
                                       ", where 00 00 00 01 was observed; its meaning is not known");
    }
    HookArea area;
    area.hooks = Cursor::big(field.value.substr(4));
    if (area.hooks > most_hooks) {
        return bad_input(what + " says " + counted(area.hooks, "hook") + "; more than " +
                             std::to_string(most_hooks) + " are not read",
                         at_byte(field.offset + 4));
    }
    area.name = ended_text(field.value.substr(area_numbers), field.offset + area_numbers,
                           "the name of " + what, oddities);
    return area;
}

/// Against the area of the profile at the same place: as many hooks; another name is told.
Status check_area(const HookArea& area, const HookArea& loom, const std::string& what, std::size_t offset,
                  Oddities& oddities) {
    if (area.hooks != loom.hooks) {
        return bad_input(what + " has " + counted(area.hooks, "hook") + ", but in the profile of the loom " +
                             std::to_string(loom.hooks),
                         at_byte(offset + 4));
    }
    if (area.name != on_one_line(loom.name)) {
        oddities.add(offset + area_numbers, what + " is called '" + area.name +
                                                "', in the profile of the loom '" + on_one_line(loom.name) +
                                                "'");
    }
    return {};
}

Status read_areas(Cursor& cursor, const LoomProfile& profile, ControllerFile& file, Oddities& oddities) {
    const std::size_t count_at = cursor.at();
    WEAVE_TRY(const std::uint32_t count, cursor.number("the number of areas"));
    if (count != profile.areas.size()) {  // before they are read: a hostile count would make a long list
        return bad_input("the file has " + counted(count, "area") +
                             " of hooks, but the profile of the loom " + std::to_string(profile.areas.size()),
                         at_byte(count_at));
    }
    for (std::uint32_t k = 0; k < count; ++k) {
        const std::string what = "area " + std::to_string(k + 1);
        WEAVE_TRY(const Field field, read_field(cursor, what));
        WEAVE_TRY(HookArea area, read_area(field, what, oddities));
        WEAVE_CHECK_OK(check_area(area, profile.areas[k], what, field.offset, oddities));
        file.areas.push_back(std::move(area));
    }
    return {};
}

/// Nothing may be missing after the header, and nothing may be left over.
Status check_data(const Cursor& cursor, std::size_t picks, std::size_t record_bytes) {
    const std::uint64_t needed = std::uint64_t{picks} * record_bytes;
    if (needed == cursor.left()) return {};
    const std::string said = counted(picks, "pick") + " of " + counted(record_bytes, "byte") + " need " +
                             std::to_string(needed) + " bytes, but the file has " +
                             std::to_string(cursor.left());
    if (needed < cursor.left()) return bad_input(said + " left for them", at_byte(cursor.at() + needed));
    return bad_input(said + " left for them and ends within pick record " +
                         std::to_string(cursor.left() / record_bytes + 1),
                     at_byte(cursor.at() + cursor.left()));
}

}  // namespace

Result<ControllerFile> read_jc5(std::string_view bytes, const LoomProfile& profile) {
    if (!bytes.starts_with(jc5_magic)) {
        return bad_input("starts with " + hexadecimal(bytes.substr(0, jc5_magic.size())) + " instead of " +
                             hexadecimal(jc5_magic) + ", so this is no JC5 file",
                         at_byte(0));
    }
    WEAVE_TRY(const HookLayout layout, hook_layout(profile));
    Cursor cursor(bytes);
    WEAVE_CHECK_OK(cursor.take(jc5_magic.size(), "the mark of a JC5 file"));
    ControllerFile file;
    file.format = OutputFormat::jc5;
    Oddities oddities;
    WEAVE_TRY(const Attributes attributes, read_attributes(cursor, oddities));
    WEAVE_TRY(const std::size_t picks, apply(attributes, cursor.at(), file, oddities));
    WEAVE_CHECK_OK(read_areas(cursor, profile, file, oddities));
    file.records_at = cursor.at();
    WEAVE_CHECK_OK(check_data(cursor, picks, layout.bytes()));
    read_records(bytes, picks, profile, layout, file, oddities);
    file.warnings = std::move(oddities).take();
    return file;
}

}  // namespace weave::controller
