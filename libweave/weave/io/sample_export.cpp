#include <weave/io/sample_export.hpp>

#include <weave/core/sha256.hpp>
#include <weave/design/document.hpp>
#include <weave/io/export_parts.hpp>
#include <weave/loom/pick_table.hpp>

namespace weave {

namespace {

constexpr const char* label = "SAMPLE, NOT RELEASED";

Json file_entry(const std::string& name, const std::string& bytes, const std::string& format) {
    return {{"path", name}, {"sha256", sha256_hex(bytes)}, {"bytes", bytes.size()}, {"format", format}};
}

}  // namespace

Result<SampleExport> make_sample_export(const Design& design, const Evaluation& cloth,
                                        const LoomProfile& profile, const std::string& stem) {
    const CardImage card = cloth.block->card_image();
    const BitmapReading reading = picture_reading(profile);
    const BitmapFormat format = picture_format(profile);
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
                     {"loom", loom_entry(profile)},
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
