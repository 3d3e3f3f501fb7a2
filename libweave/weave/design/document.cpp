#include <weave/design/document.hpp>

#include <weave/core/file.hpp>
#include <weave/core/sha256.hpp>
#include <weave/design/node_json.hpp>
#include <weave/design/plan_json.hpp>

namespace weave {

namespace {

/// What is hashed as the design: all but scene and view.
Json design_json(const Design& design) {
    Json blocks = Json::object();
    for (const auto& [name, node] : design.blocks) blocks[name] = to_json(*node);
    return {{"format", "weave"},
            {"version", document_version},
            {"title", design.title},
            {"notes", design.notes},
            {"root", design.root},
            {"blocks", std::move(blocks)},
            {"warp", to_json(design.warp)},
            {"weft", to_json(design.weft)}};
}

Status check_version(const Json& document) {
    if (!document.is_object() || document.value("format", Json()) != "weave") {
        return bad_input("is not a .weave document: it has no \"format\": \"weave\"");
    }
    const Json version = document.value("version", Json());
    const bool whole = version.is_number_integer();
    const bool huge = version.is_number_unsigned() && version.get<std::uint64_t>() > INT64_MAX;
    if (!whole || (!huge && version.get<std::int64_t>() < 1))
        return bad_input("must be a whole number from 1 on", "version");
    if (huge || version.get<std::int64_t>() > document_version) {
        return bad_input("is " + version.dump() + ", newer than this program, which reads versions up to " +
                             std::to_string(document_version),
                         "version");
    }
    return {};
}

}  // namespace

std::string write_document(const Design& design) {
    Json document = design_json(design);
    document["scene"] = to_json(design.scene);
    if (!design.view.empty()) document["view"] = design.view;
    return document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Status check_beginning(std::string_view text) {
    if (text.starts_with("weave-yarns ")) return bad_input("holds relaxed yarns, no design");
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos || text[first] == '{' || text[first] == '[') return {};
    return bad_input("is no design, which would begin with {; cards, WIF and files of loom controllers have to be imported first");
}

Result<Design> read_document(std::string_view text) {
    auto parsed = parse_json(text);
    if (!parsed) {
        WEAVE_CHECK_OK(check_beginning(text));  // where another kind of file is no JSON would help nobody
        return std::move(parsed).error();
    }
    const Json document = *std::move(parsed);
    WEAVE_CHECK_OK(check_version(document));
    JsonReader reader(document, "");
    static_cast<void>(reader.raw("format"));
    static_cast<void>(reader.raw("version"));
    Design design;
    design.title = reader.text("title", "", longest_title);
    design.notes = reader.text("notes", "", longest_notes);
    design.root = reader.text("root");
    JsonReader blocks = reader.object("blocks");
    for (const auto& [name, node] : blocks.named_objects()) {
        if (reader.failed()) break;
        if (Status fine = check_block_name(name); !fine) return std::move(fine).error().under("blocks");
        Result<NodePtr> made = node_from_json(node.json());
        if (!made) return std::move(made).error().under("blocks." + name);
        design.blocks[name] = std::move(made).value();
    }
    design.warp = warp_from_json(reader.object("warp", true));
    design.weft = weft_from_json(reader.object("weft", true));
    design.scene = scene_from_json(reader.object("scene", true));
    design.view = reader.object("view", true).json();
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    WEAVE_CHECK_OK(check(design));
    return design;
}

Result<Design> load_design(const std::filesystem::path& path) {
    WEAVE_TRY(const std::string text, read_file(path));
    Result<Design> design = read_document(text);
    if (!design) return std::move(design).error().in(path.string());
    return design;
}

Status save_design(const Design& design, const std::filesystem::path& path) {
    return write_file(path, write_document(design));
}

std::string design_sha256(const Design& design) {
    return sha256_hex(canonical_json(design_json(design)));
}

std::string scene_sha256(const Design& design) {
    return sha256_hex(canonical_json(to_json(design.scene)));
}

}  // namespace weave
