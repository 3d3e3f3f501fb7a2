#include <weave/io/open_design.hpp>

#include <weave/core/file.hpp>
#include <weave/design/document.hpp>
#include <weave/io/bitmap.hpp>
#include <weave/io/controller_file.hpp>
#include <weave/io/wif.hpp>

#include <memory>
#include <utility>

namespace weave {

Design design_of_card(CardImage card) {
    Design design;
    design.root = "card";
    const CardLeaf leaf{std::make_shared<const CardImage>(std::move(card)), {1}, {1}};
    design.blocks["card"] = std::make_shared<const Node>(Node{leaf, {}});
    return design;
}

namespace {

bool looks_like_json(std::string_view bytes) {
    const std::size_t first = bytes.find_first_not_of(" \t\r\n");
    return first != std::string_view::npos && bytes[first] == '{';
}

Result<OpenedDesign> from_bytes(std::string_view bytes, std::string_view extension) {
    if (is_bitmap(bytes)) {
        WEAVE_TRY(CardFromBitmap read, read_bitmap(bytes));
        return OpenedDesign{design_of_card(std::move(read.card)), false, std::move(read.warnings)};
    }
    if (is_wif(bytes)) {
        WEAVE_TRY(DesignFromWif read, read_wif(bytes));
        return OpenedDesign{std::move(read.design), false, std::move(read.warnings)};
    }
    auto design = read_document(bytes);
    if (design) return OpenedDesign{*std::move(design), true, {}};
    if (looks_like_json(bytes)) return std::move(design).error();
    if (recognise_controller_file(bytes, extension))
        return bad_input("is a file of a loom's controller, which is read as its loom's profile says: weave import FILE --loom LOOM.json -o NAME.weave");
    return bad_input("is no design, WIF file or picture of a card (.weave, .wif, .png, .tif, .bmp), or is damaged at its beginning");
}

}  // namespace

Result<OpenedDesign> open_design(const std::filesystem::path& path) {
    WEAVE_TRY(const std::string bytes, read_file(path));
    auto opened = from_bytes(bytes, lower_extension(path));
    if (!opened) return std::move(opened).error().in(path.string());
    return opened;
}

}  // namespace weave
