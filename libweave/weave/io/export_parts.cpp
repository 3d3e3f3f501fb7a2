#include <weave/io/export_parts.hpp>

#include <cctype>

namespace weave {

std::string plain_name(const std::string& stem) {
    std::string name;
    for (const char c : stem) {
        const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
        name.push_back(plain ? c : '-');
    }
    return name.empty() ? "design" : name.substr(0, 100);
}

BitmapFormat picture_format(const LoomProfile& profile) {
    switch (profile.output) {
        case OutputFormat::tiff:
            return BitmapFormat::tiff;
        case OutputFormat::bmp:
            return BitmapFormat::bmp;
        default:
            return BitmapFormat::png;
    }
}

BitmapReading picture_reading(const LoomProfile& profile) {
    if (!takes_picture(profile.output)) return {};
    return {profile.pick_1_at_bottom, profile.end_1_at_left, profile.lifted_is_one};
}

const char* name_of(BitmapFormat format) {
    switch (format) {
        case BitmapFormat::png:
            return "png";
        case BitmapFormat::tiff:
            return "tiff";
        case BitmapFormat::bmp:
            return "bmp";
    }
    return "";
}

const char* extension_of(BitmapFormat format) {
    return format == BitmapFormat::tiff ? "tif" : name_of(format);
}

Json reading_entry(const BitmapReading& reading, BitmapFormat format) {
    return {{"lifted_end", reading.black_is_lifted ? "black" : "white"},
            {"weft_over_warp", reading.black_is_lifted ? "white" : "black"},
            {"pick_1", reading.pick_1_at_bottom ? "bottom row" : "top row"},
            {"end_1", reading.end_1_at_left ? "left column" : "right column"},
            {"bit_order", "most significant bit first"},
            {"stored_bit_of_black", format == BitmapFormat::tiff ? 1 : 0},
            {"seen_from", "face"}};
}

Json loom_entry(const LoomProfile& profile) {
    return {{"name", profile.name},
            {"maker", profile.maker},
            {"revision", profile.version},
            {"sha256", profile.sha256}};
}

}  // namespace weave
