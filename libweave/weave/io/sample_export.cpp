#include <weave/core/sha256.hpp>
#include <weave/design/document.hpp>
#include <weave/io/bitmap.hpp>
#include <weave/io/sample_export.hpp>
#include <weave/loom/pick_table.hpp>

#include <cctype>

namespace weave {

namespace {

constexpr const char* label = "SAMPLE, NOT RELEASED";

/// A file name that every mill's system takes.
std::string plain_name(const std::string& stem) {
    std::string name;
    for (const char c : stem) {
        const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
        name.push_back(plain ? c : '-');
    }
    return name.empty() ? "design" : name.substr(0, 100);
}

/// Looms that take pictures get their own kind; for controller formats the picture is a sample to look at.
BitmapFormat picture_for(OutputFormat output) {
    switch (output) {
        case OutputFormat::tiff:
            return BitmapFormat::tiff;
        case OutputFormat::bmp:
            return BitmapFormat::bmp;
        default:
            return BitmapFormat::png;
    }
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

Json file_entry(const std::string& name, const std::string& bytes, const std::string& format) {
    return {{"path", name}, {"sha256", sha256_hex(bytes)}, {"bytes", bytes.size()}, {"format", format}};
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

}  // namespace

Result<SampleExport> make_sample_export(const Design& design, const Evaluation& cloth,
                                        const LoomProfile& profile, const std::string& stem) {
    const CardImage card = cloth.block->card_image();
    const BitmapReading reading{profile.pick_1_at_bottom, profile.end_1_at_left, true};
    const BitmapFormat format = picture_for(profile.output);
    WEAVE_TRY(std::string picture, write_proven_bitmap(card, format, reading));
    const std::string base = plain_name(stem) + "-SAMPLE-NOT-RELEASED";
    const std::string picture_name = base + "-card." + extension_of(format), table_name = base + "-picks.csv";
    std::string table = pick_table_csv(design, pick_table(design, *cloth.block));
    SampleExport made;
    made.manifest = {{"format", "weave-export"},
                     {"version", 1},
                     {"status", label},
                     {"released", false},
                     {"certified", false},
                     {"title", design.title},
                     {"picks", card.picks()},
                     {"ends", card.ends()},
                     {"design_sha256", design_sha256(design)},
                     {"scene_sha256", scene_sha256(design)},
                     {"card_sha256", card.sha256()},
                     {"loom",
                      {{"name", profile.name},
                       {"maker", profile.maker},
                       {"revision", profile.version},
                       {"sha256", profile.sha256}}},
                     {"card", reading_entry(reading, format)},
                     {"read_back", "equal"},
                     {"files", Json::array({file_entry(picture_name, picture, name_of(format)),
                                            file_entry(table_name, table, "pick-table-csv")})}};
    std::string manifest = made.manifest.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
    const std::string manifest_name = base + "-manifest.json";
    made.manifest["files"].push_back(file_entry(manifest_name, manifest, "manifest-json"));
    made.files = {{picture_name, std::move(picture)},
                  {table_name, std::move(table)},
                  {manifest_name, std::move(manifest)}};
    return made;
}

}  // namespace weave
