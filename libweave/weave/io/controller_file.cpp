#include <weave/io/controller_file.hpp>

#include <weave/core/text.hpp>
#include <weave/io/controller_reader.hpp>

#include <algorithm>

namespace weave {

namespace controller {

namespace {

constexpr std::size_t most_oddities = 100;
constexpr std::size_t most_shown_bytes = 16;

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
    const std::string_view text = field.substr(0, end);
    std::string shown = on_one_line(text);
    if (shown != text) oddities.add(offset, what + " holds what cannot be shown; read as '" + shown + "'");
    return shown;
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
