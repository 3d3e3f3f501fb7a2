#include <weave/core/text.hpp>
#include <weave/io/controller_reader.hpp>

#include <algorithm>

namespace weave {

namespace controller {

namespace {

constexpr std::size_t most_oddities = 100;
constexpr std::size_t most_shown_bytes = 16;

/// Where the bit of a hook stands among the hook bytes of a record.
struct BitPlace {
    std::size_t byte = 0;
    std::uint8_t mask = 1;
};

Result<std::vector<BitPlace>> bit_places(std::size_t hooks, const LoomProfile& profile) {
    const std::vector<std::size_t>& permutation = profile.hook_permutation;
    const bool fits = permutation.empty() ||
                      (permutation.size() == hooks &&
                       std::ranges::all_of(permutation, [&](std::size_t place) { return place < hooks; }));
    if (!fits) return bad_input("the profile's hook permutation does not fit its hooks");
    std::vector<BitPlace> places(hooks);
    for (std::size_t hook = 0; hook < hooks; ++hook) {
        const std::size_t place = permutation.empty() ? hook : permutation[hook];
        const std::size_t bit = profile.least_bit_first ? place % 8 : 7 - place % 8;
        places[hook] = {place / 8, static_cast<std::uint8_t>(1U << bit)};
    }
    return places;
}

}  // namespace

std::string at_byte(std::size_t offset) {
    return "byte " + std::to_string(offset);
}

std::string hexadecimal(std::string_view bytes) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string text;
    for (const char c : bytes.substr(0, most_shown_bytes)) {
        const auto byte = static_cast<std::uint8_t>(c);
        if (!text.empty()) text += ' ';
        text += {digits[byte >> 4], digits[byte & 15]};
    }
    return bytes.size() > most_shown_bytes ? text + " …" : text;
}

std::uint32_t little(std::string_view bytes, std::size_t at, std::size_t count) {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < count; ++k) value |= std::uint32_t{byte_at(bytes, at + k)} << 8 * k;
    return value;
}

void Oddities::add(std::size_t offset, const std::string& message) {
    if (m_texts.size() < most_oddities) {
        m_texts.push_back(at_byte(offset) + ": " + message);
    } else {
        ++m_left_out;
    }
}

std::vector<std::string> Oddities::take() && {
    if (m_left_out > 0) m_texts.push_back("and " + counted(m_left_out, "more warning"));
    return std::move(m_texts);
}

std::string text_of(std::string_view field, std::size_t offset, const std::string& what, Oddities& oddities) {
    const std::size_t end = std::min(field.find('\0'), field.size());
    const std::size_t more = field.find_first_not_of('\0', end);
    if (more != std::string_view::npos) {
        oddities.add(offset + more, "after the NUL that ends it " + what + " goes on with " +
                                        hexadecimal(field.substr(more)) + "; not read");
    }
    const std::string_view filled = field.substr(0, end);
    const std::string_view text = filled.substr(0, filled.find_last_not_of(' ') + 1);
    std::string shown = on_one_line(text);
    if (shown != text) oddities.add(offset, what + " holds what cannot be shown; read as '" + shown + "'");
    return shown;
}

Status check_whole_bytes(std::size_t hooks, std::size_t offset) {
    if (hooks > 0 && hooks % 8 == 0) return {};
    return bad_input(counted(hooks, "hook") + " fill no whole bytes; how a file packs that is not known",
                     at_byte(offset));
}

Status read_lifts(std::string_view bytes, std::size_t picks, const LoomProfile& profile,
                  ControllerFile& file) {
    const std::size_t hooks = profile.total_hooks, hook_bytes = hooks / 8;
    WEAVE_CHECK_OK(check_whole_bytes(hooks, file.records_at));
    WEAVE_TRY(const std::vector<BitPlace> places, bit_places(hooks, profile));
    file.last_pick_first = !profile.pick_1_at_bottom;
    file.lifts = HookLifts(picks, hooks);
    for (std::size_t pick = 0; pick < picks; ++pick) {
        const std::size_t at = file.offset_of(pick) + file.record_bytes - hook_bytes;
        const std::string_view record = bytes.substr(at, hook_bytes);
        for (std::size_t hook = 0; hook < hooks; ++hook) {
            const bool one = (byte_at(record, places[hook].byte) & places[hook].mask) != 0;
            if (one == profile.lifted_is_one) file.lifts.lift(pick, hook);
        }
    }
    return {};
}

Result<ControllerFile> read_raw(std::string_view bytes, const LoomProfile& profile) {
    WEAVE_CHECK_OK(check_whole_bytes(profile.total_hooks, 0));
    ControllerFile file;
    file.format = OutputFormat::raw;
    file.areas = {{"", profile.total_hooks}};
    file.record_bytes = profile.total_hooks / 8;
    if (bytes.empty()) return bad_input("the file is empty", at_byte(0));
    if (const std::size_t rest = bytes.size() % file.record_bytes; rest != 0) {
        return bad_input("the file ends " + counted(rest, "byte") + " into a pick of " +
                             counted(file.record_bytes, "byte"),
                         at_byte(bytes.size()));
    }
    WEAVE_CHECK_OK(read_lifts(bytes, bytes.size() / file.record_bytes, profile, file));
    return file;
}

}  // namespace controller

std::optional<OutputFormat> recognise_controller_file(std::string_view bytes, std::string_view extension) {
    if (bytes.starts_with(controller::jc5_magic)) return OutputFormat::jc5;
    if (controller::looks_like_ep(bytes)) return OutputFormat::ep;
    if (extension == ".jc5") return OutputFormat::jc5;
    if (extension == ".ep") return OutputFormat::ep;
    return {};
}

Result<ControllerFile> read_controller_file(std::string_view bytes, const LoomProfile& profile) {
    switch (profile.output) {
        case OutputFormat::jc5:
            return controller::read_jc5(bytes, profile);
        case OutputFormat::ep:
            return controller::read_ep(bytes, profile);
        case OutputFormat::raw:
            return controller::read_raw(bytes, profile);
        case OutputFormat::tiff:
        case OutputFormat::png:
        case OutputFormat::bmp:
            break;
    }
    return bad_input("the loom '" + on_one_line(profile.name) + "' takes pictures, no controller files");
}

}  // namespace weave
