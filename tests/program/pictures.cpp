// Every view that `render` knows, in every format, and the card in its three.

#include "run.hpp"

#include <weave/io/bitmap.hpp>

using program_tests::Workshop;
using weave::Json;

namespace {

bool is_png(const std::string& bytes) {
    return bytes.rfind("\x89PNG\r\n\x1a\n", 0) == 0 && bytes.find("IEND") != std::string::npos;
}
bool is_svg(const std::string& bytes) {
    return bytes.find("<svg") != std::string::npos && bytes.find("</svg>") != std::string::npos;
}

}  // namespace

TEST_CASE("every view is drawn, as PNG and as SVG, trimmed or not") {
    const Workshop shop;
    shop.must({"samples", "layer-to-layer", "-o", "d.weave"});
    std::set<std::string> different;
    for (const std::string view : {"card", "face", "back", "floats", "layers", "weft:1", "warp:2", "block"})
        for (const std::string extension : {".png", ".svg"}) {
            INFO(view << extension);
            const std::string file = "picture" + extension;
            const Json answer = shop.json({"render", "d.weave", "--view", view, "-o", file});
            const std::string bytes = shop.get(file);
            CHECK(answer.at("file") == file);
            CHECK(answer.at("view") == view);
            CHECK(answer.at("bytes") == bytes.size());
            CHECK((extension == ".png" ? is_png(bytes) : is_svg(bytes)));
            different.insert(bytes);
            shop.must({"render", "d.weave", "--view", view, "--trim", "-o", "trimmed" + extension});
            const std::string trimmed = shop.get("trimmed" + extension);
            CHECK((extension == ".png" ? is_png(trimmed) : is_svg(trimmed)));
        }
    CHECK(different.size() == 16);  // no view is another one's picture
}

TEST_CASE("the card is the same in PNG, TIFF and BMP, whatever the case of the extension") {
    const Workshop shop;
    shop.must({"samples", "twill-g", "-o", "d.weave"});
    const std::string hash = shop.json({"info", "d.weave"}).at("card_sha256");
    for (const std::string file : {"c.png", "c.tif", "c.bmp", "c.TIFF", "c.PNG"}) {
        INFO(file);
        const Json answer = shop.json({"card", "d.weave", "-o", file});
        CHECK(answer.at("card_sha256") == hash);
        const weave::Result<weave::CardFromBitmap> read = weave::read_bitmap(shop.get(file));
        REQUIRE(read);
        CHECK(read->card.sha256() == hash);
        CHECK(read->card.picks() == answer.at("picks"));
        CHECK(read->card.ends() == answer.at("ends"));
    }
    CHECK(shop.get("c.tif").rfind("II*", 0) == 0);
    CHECK(shop.get("c.bmp").rfind("BM", 0) == 0);
}

TEST_CASE("a card written as WIF is imported again as the same card, whatever its sample") {
    const Workshop shop;
    for (const char* name : {"twill-g", "layer-to-layer", "three-colour-stencil"}) {
        INFO(name);
        shop.must({"samples", name, "-o", "d.weave"});
        const Json card = shop.json({"card", "d.weave", "-o", "c.wif"});
        CHECK(shop.get("c.wif").rfind("[WIF]", 0) != std::string::npos);
        const Json back = shop.json({"import", "c.wif", "-o", "back.weave"});
        CHECK(back.at("picks") == card.at("picks"));
        CHECK(back.at("ends") == card.at("ends"));
        CHECK(shop.json({"info", "back.weave"}).at("card_sha256") == card.at("card_sha256"));
    }
}
