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

TEST_CASE("slices and the block begin at the pick and end that are asked for") {
    const Workshop shop;
    shop.must({"samples", "shoe-adult", "-o", "d.weave"});
    const auto picture = [&](std::vector<std::string> words) {
        words.insert(words.begin(), {"render", "d.weave", "--view"});
        words.insert(words.end(), {"-o", "p.svg"});
        shop.must(words);
        return shop.get("p.svg");
    };
    const std::string first = picture({"weft:3000"});
    CHECK(picture({"weft:3000", "--from-end", "1"}) == first);
    CHECK(picture({"weft:3000", "--from-end", "1081"}) != first);
    CHECK(picture({"weft:3000", "--from-end", "1", "--to-end", "60"}) != first);
    CHECK(picture({"weft:3000", "--to-end", "2400"}) == first);  // no more than there is room for
    CHECK(picture({"warp:1200", "--from-pick", "3000"}) != picture({"warp:1200"}));
    std::set<std::string> blocks{picture({"block"}), picture({"block", "--from-pick", "3000"}),
                                 picture({"block", "--from-end", "1081"}),
                                 picture({"block", "--from-pick", "3000", "--from-end", "1081"})};
    CHECK(blocks.size() == 4);
    shop.refused({"render", "d.weave", "--view", "weft:1", "--from-pick", "2", "-o", "n.png"}, 2,
                 {"warp slices and the block"});
    shop.refused({"render", "d.weave", "--view", "face", "--from-end", "2", "-o", "n.png"}, 2,
                 {"weft slices and the block"});
    shop.refused({"render", "d.weave", "--view", "block", "--from-end", "2401", "-o", "n.png"}, 2,
                 {"2401", "1 to 2400"});
    shop.refused({"render", "d.weave", "--view", "weft:1", "--from-end", "9", "--to-end", "8", "-o", "n.png"}, 2,
                 {"from end 9 cannot end at end 8"});
    shop.refused({"render", "d.weave", "--view", "block", "--from-pick", "middle", "-o", "n.png"}, 2,
                 {"--from-pick"});
}

TEST_CASE("an option of the 3d view is refused with every other view, not passed over") {
    const Workshop shop;
    shop.must({"preset", "plain", "-o", "a.weave"});
    const std::vector<std::vector<std::string>> options{{"--side", "top"},      {"--cut", "x=1"},
                                                        {"--colour", "strain"}, {"--repeat", "2x2"},
                                                        {"--size", "400x300"},  {"--perspective"}};
    for (const std::vector<std::string>& option : options) {
        for (const char* view : {"card", "face", "floats", "weft:1", "block"}) {
            std::vector<std::string> words{"render", "a.weave", "--view", view, "-o", "x.png"};
            words.insert(words.end(), option.begin(), option.end());
            shop.refused(words, 2, {option[0] + " is for --view 3d", std::string("--view ") + view});
        }
    }
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

TEST_CASE("a cloth with a row or a column without yarns is written as WIF, and says what is lost") {
    const Workshop shop;
    shop.put("d.weave", R"({"format":"weave","version":1,"root":"a","blocks":{"a":{"kind":"stacks",)"
                        R"("stacks":[["T0 P0","T0","P1 T0 P2"],["P0","-","P1 P2"],["P0 T1","T1","P2 T1 P1"]]}}})");
    const Json info = shop.json({"info", "d.weave"});
    const program_tests::Ended ended = shop.run({"card", "d.weave", "-o", "c.wif"});
    CHECK(ended.exit == 0);
    CHECK(ended.complaints() ==
          std::vector<std::string>{"weave: c.wif: WIF cannot hold, and the file does not say: the rows without "
                                   "picks, the columns without ends"});
    shop.must({"import", "c.wif", "-o", "back.weave"});
    const Json back = shop.json({"info", "back.weave"});
    CHECK(back.at("card_sha256") == info.at("card_sha256"));
    CHECK(back.at("rows") == 2);
    CHECK(back.at("columns") == 2);

    shop.put("s.weave", R"({"format":"weave","version":1,"root":"a","blocks":{"a":{"kind":"slice","dots":"weft",)"
                        R"j("positions":["T0 P0","P0 (T0)","P0 T0"]}}})j");
    CHECK(shop.run({"card", "s.weave", "-o", "s.wif"}).exit == 0);
    shop.must({"import", "s.wif", "-o", "s2.weave"});
    CHECK(shop.json({"info", "s2.weave"}).at("card_sha256") == shop.json({"info", "s.weave"}).at("card_sha256"));
}

TEST_CASE("card tells in one line what WIF cannot hold of a design, and only what the design has") {
    const Workshop shop;
    const auto lost = [&](const Json& scene, const std::string& sample, const std::string& out) {
        shop.must({"samples", sample, "-o", "d.weave"});
        Json design = Json::parse(shop.get("d.weave"));
        design["scene"].update(scene);
        shop.put("d.weave", design.dump());
        const program_tests::Ended ended = shop.run({"card", "d.weave", "-o", out});
        CHECK(ended.exit == 0);
        CHECK(shop.has(out));
        return ended.complaints();
    };
    using Lines = std::vector<std::string>;
    const std::string head = "weave: c.wif: WIF cannot hold, and the file does not say: ";
    CHECK(lost(Json::object(), "twill-g", "c.wif") == Lines{});
    CHECK(lost(Json::object(), "shoe-baby", "c.png") == Lines{});
    CHECK(lost(Json::object(), "shoe-baby", "c.wif") == Lines{head + "which yarns are loose on purpose, that the wefts turn "
                                                         "(weft_mode wraparound), the boundaries"});
    CHECK(lost({{"pins", {{{"system", "pick"}, {"number", 1}}}}}, "twill-g", "c.wif") == Lines{head + "the pins"});
    CHECK(lost({{"gravity", true}}, "twill-g", "c.wif") == Lines{head + "the rest of the scene"});
    CHECK(lost({{"fields",
                 {{{"centre_mm", {1, 1, 0}}, {"radius_mm", 1}, {"strength_N_per_mm", 1}}}}},
               "twill-g", "c.wif") == Lines{head + "the fields"});
    CHECK(lost({{"boundary_x", "frozen"}}, "twill-g", "c.wif") == Lines{head + "the boundaries"});
    // What is told is true: these are not there when the file comes back.
    CHECK(lost(Json::object(), "shoe-baby", "c.wif").size() == 1);
    shop.must({"import", "c.wif", "-o", "back.weave"});
    CHECK(Json::parse(shop.get("back.weave")).at("scene").at("weft_mode") == "periodic");
}
