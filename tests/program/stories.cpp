// Whole ways through the program: what a designer does from the first weave to the card and back.

#include "run.hpp"

#include <weave/block/card_image.hpp>
#include <weave/core/sha256.hpp>
#include <weave/io/bitmap.hpp>

#include <algorithm>
#include <sstream>

using program_tests::Ended;
using program_tests::loom;
using program_tests::Workshop;
using weave::CardImage;
using weave::Json;

namespace {

CardImage card_of(const Workshop& shop, const std::string& design) {
    shop.must({"card", design, "-o", "card-of.bmp"});
    weave::Result<weave::CardFromBitmap> read = weave::read_bitmap(shop.get("card-of.bmp"));
    REQUIRE(read);
    CHECK(read->warnings.empty());
    return std::move(read->card);
}

std::vector<std::pair<std::size_t, std::size_t>> differing(const CardImage& a, const CardImage& b) {
    std::vector<std::pair<std::size_t, std::size_t>> places;
    REQUIRE(a.picks() == b.picks());
    REQUIRE(a.ends() == b.ends());
    for (std::size_t i = 0; i < a.picks(); ++i)
        for (std::size_t j = 0; j < a.ends(); ++j)
            if (a.weft_over(i, j) != b.weft_over(i, j)) places.emplace_back(i + 1, j + 1);
    return places;
}

/// What must hold of the answer to a command that writes a design.
void check_answer(const Json& answer, const std::string& file) {
    CHECK(answer.at("file") == file);
    for (const char* key : {"picks", "ends", "rows", "columns", "height"}) {
        INFO(key);
        CHECK(answer.at(key).is_number_unsigned());
    }
    CHECK(answer.at("warnings").is_array());
}

}  // namespace

TEST_CASE("from presets by tiling, attaching and a stencil to a card, and back to the same card") {
    const Workshop shop;
    check_answer(shop.json({"preset", "twill", "up=3", "down=1", "-o", "twill.weave"}), "twill.weave");
    check_answer(shop.json({"preset", "basket", "-o", "basket.weave"}), "basket.weave");
    const Json tiled = shop.json({"tile", "twill.weave", "--x", "2", "--y", "3", "-o", "wide.weave"});
    check_answer(tiled, "wide.weave");
    CHECK(tiled.at("picks") == 8);
    CHECK(tiled.at("ends") == 12);

    weave::ColourImage picture{2, 3, std::vector<weave::Colour>(6, weave::Colour{255, 0, 0})};
    picture.pixels[0] = picture.pixels[5] = weave::Colour{0, 0, 255};
    shop.put("map.png", *weave::write_png(picture));
    const Json stencilled = shop.json({"stencil", "map.png", "--map", "#ff0000=twill.weave", "--map",
                                       "#0000ff=basket.weave", "-o", "s.weave"});
    check_answer(stencilled, "s.weave");
    CHECK(stencilled.at("rows") == 2);  // one pixel, one stack; the bottom row of the picture is row 0
    CHECK(stencilled.at("columns") == 3);
    const CardImage twill = card_of(shop, "twill.weave"), basket = card_of(shop, "basket.weave"),
                    merged = card_of(shop, "s.weave");
    for (std::size_t i = 0; i < 2; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            const bool blue = picture.pixels[i * 3 + j] == weave::Colour{0, 0, 255};
            CHECK(merged.weft_over(i, j) == (blue ? basket : twill).weft_over(i % 4, j % 4));
        }

    const Json info = shop.json({"info", "s.weave"});
    const Json kinds = info.at("tree");
    CHECK(
        std::any_of(kinds.begin(), kinds.end(), [](const Json& one) { return one.at("kind") == "stencil"; }));
    CHECK(info.at("blocks") == 3);  // the operation tree is kept, with the presets as leaves
}

TEST_CASE("a layered design comes back from its card with the same t and p") {
    const Workshop shop;
    shop.must({"preset", "layer-to-layer", "layers=3", "-o", "l.weave"});
    const Json info = shop.json({"info", "l.weave"});
    const auto rows = info.at("rows").get<std::size_t>(), picks = info.at("picks").get<std::size_t>();
    const auto columns = info.at("columns").get<std::size_t>(), ends = info.at("ends").get<std::size_t>();
    REQUIRE(picks % rows == 0);
    REQUIRE(ends % columns == 0);
    for (const std::string card : {"c.png", "c.tif", "c.bmp"}) {
        INFO(card);
        const Json written = shop.json({"card", "l.weave", "-o", card});
        CHECK(written.at("card_sha256") == info.at("card_sha256"));
        const Json read = shop.json({"import", card, "-o", "back.weave", "--t", std::to_string(picks / rows),
                                     "--p", std::to_string(ends / columns)});
        CHECK(read.at("picks") == info.at("picks"));
        CHECK(read.at("ends") == info.at("ends"));
        CHECK(read.at("warnings") == Json::array());
        const Json back = shop.json({"info", "back.weave"});
        for (const char* key : {"card_sha256", "rows", "columns", "picks", "ends"}) {
            INFO(key);
            CHECK(back.at(key) == info.at(key));
        }
    }
}

TEST_CASE("info answers with its documented keys, and the hashes mean what they say") {
    const Workshop shop;
    shop.must({"preset", "satin", "-o", "s.weave"});
    const Json info = shop.json({"info", "s.weave"});
    for (const char* key : {"rows", "columns", "height", "picks", "ends", "blocks"}) {
        INFO(key);
        CHECK(info.at(key).is_number_unsigned());
    }
    for (const char* key : {"card_sha256", "design_sha256"}) {
        const std::string hash = info.at(key);
        CHECK(hash.size() == 64);
        CHECK(hash.find_first_not_of("0123456789abcdef") == std::string::npos);
    }
    // The packed card by hand: rows from pick 1, most significant bit first, 1 = weft over warp.
    const CardImage card = card_of(shop, "s.weave");
    std::string packed;
    for (std::size_t i = 0; i < 5; ++i) {
        unsigned byte = 0;
        for (std::size_t j = 0; j < 5; ++j)
            if (card.weft_over(i, j)) byte |= 0x80U >> j;
        packed.push_back(static_cast<char>(byte));
    }
    CHECK(info.at("card_sha256") == weave::sha256_hex(packed));

    Json document = *weave::parse_json(shop.get("s.weave"));
    document["view"] = {{"zoom", 3}};
    shop.put("viewed.weave", document.dump());
    CHECK(shop.json({"info", "viewed.weave"}).at("design_sha256") == info.at("design_sha256"));
    document["title"] = "another";
    shop.put("titled.weave", document.dump());
    CHECK(shop.json({"info", "titled.weave"}).at("design_sha256") != info.at("design_sha256"));
}

TEST_CASE("attach joins on each of the six faces, B beside, before, above or below A") {
    const Workshop shop;
    shop.must({"preset", "twill", "up=3", "down=1", "-o", "a.weave"});
    shop.must({"preset", "twill", "up=1", "down=3", "-o", "b.weave"});
    const CardImage a = card_of(shop, "a.weave"), b = card_of(shop, "b.weave");
    for (const std::string face : {"+x", "-x", "+y", "-y", "+z", "-z"}) {
        INFO(face);
        const Json answer = shop.json({"attach", "a.weave", "b.weave", "--face", face, "-o", "c.weave"});
        check_answer(answer, "c.weave");
        const char axis = face[1];
        CHECK(answer.at("rows") == (axis == 'x' ? 8 : 4));
        CHECK(answer.at("columns") == (axis == 'y' ? 8 : 4));
        CHECK(answer.at("height") == (axis == 'z' ? 4 : 2));
        const CardImage c = card_of(shop, "c.weave");
        const bool after = face[0] == '+';
        if (axis ==
            'z') {  // in each stack the lower cloth's yarns come first; all of them lie below the upper's
            REQUIRE(c.picks() == 8);
            REQUIRE(c.ends() == 8);
            const CardImage &lower = after ? a : b, &upper = after ? b : a;
            for (std::size_t i = 0; i < 8; ++i)
                for (std::size_t j = 0; j < 8; ++j) {
                    const bool high_pick = i % 2 == 1, high_end = j % 2 == 1;
                    const bool over = high_pick == high_end
                                          ? (high_pick ? upper : lower).weft_over(i / 2, j / 2)
                                          : high_pick;
                    CHECK(c.weft_over(i, j) == over);
                }
            continue;
        }
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < 4; ++j) {
                const std::size_t down = axis == 'x' ? 4 : 0, right = axis == 'y' ? 4 : 0;
                CHECK(c.weft_over(i + (after ? 0 : down), j + (after ? 0 : right)) == a.weft_over(i, j));
                CHECK(c.weft_over(i + (after ? down : 0), j + (after ? right : 0)) == b.weft_over(i, j));
            }
    }
}

TEST_CASE("attach refuses what does not fit and names the row or column") {
    const Workshop shop;
    shop.must({"preset", "plain", "-o", "plain.weave"});
    shop.must({"preset", "satin", "-o", "satin.weave"});
    shop.must({"preset", "multi-layer", "-o", "double.weave"});
    shop.refused({"attach", "plain.weave", "satin.weave", "--face", "+x", "-o", "new.weave"}, 3, {"column"});
    shop.refused({"attach", "plain.weave", "satin.weave", "--face", "+y", "-o", "new.weave"}, 3, {"row"});
    shop.refused({"attach", "plain.weave", "satin.weave", "--face", "-z", "-o", "new.weave"}, 3, {"row"});
    shop.refused({"attach", "plain.weave", "double.weave", "--face", "-y", "-o", "new.weave"}, 3, {"at pick 1 "});
    shop.refused({"attach", "plain.weave", "double.weave", "--face", "-x", "-o", "new.weave"}, 3,
                 {"at end 1 "});
}

TEST_CASE("tile refuses a cloth that is larger than any card may be") {
    const Workshop shop;
    shop.must({"preset", "plain", "-o", "plain.weave"});
    shop.refused({"tile", "plain.weave", "--x", "1000000", "--y", "1000000", "-o", "new.weave"}, 3,
                 {"crossings"});
}

TEST_CASE("a card that no file of its kind holds is refused with the file's name and what to do") {
    const Workshop shop;
    shop.must({"preset", "plain", "-o", "plain.weave"});
    shop.must({"tile", "plain.weave", "--x", "2100000", "-o", "tall.weave"});
    shop.must({"tile", "plain.weave", "--x", "1050000", "-o", "less.weave"});
    shop.refused({"card", "tall.weave", "-o", "tall.png"}, 3, {"tall.png", "4200000", "4194304"});
    shop.refused({"card", "tall.weave", "-o", "tall.wif"}, 3, {"tall.wif", "2097152", "smaller repeat"});
    shop.refused({"card", "less.weave", "-o", "less.wif"}, 3, {"less.wif", "2097152", "bitmap"});
    CHECK(shop.json({"card", "tall.weave", "-o", "tall.png"}, 3).at("error").at("where") == "tall.png");
    shop.must({"card", "less.weave", "-o", "less.png"});
}

TEST_CASE("a bare card finds its rows and columns by itself") {
    const Workshop shop;
    shop.must({"samples", "layer-to-layer", "-o", "l.weave"});
    const Json info = shop.json({"info", "l.weave"});
    shop.must({"card", "l.weave", "-o", "l.png"});
    const Json answer = shop.json({"import", "l.png", "--infer", "-o", "back.weave"});
    CHECK(shop.json({"info", "back.weave"}).at("card_sha256") == info.at("card_sha256"));
    const Json& groupings = answer.at("groupings");
    REQUIRE(!groupings.empty());
    for (const Json& one : groupings) {
        CHECK(one.at("t").is_array());
        CHECK(one.at("p").is_array());
        CHECK(one.at("reason").is_string());
    }
    for (std::size_t k = 1; k <= std::min<std::size_t>(groupings.size(), 3); ++k) {
        shop.must({"import", "l.png", "--infer", "--grouping", std::to_string(k), "-o", "other.weave"});
        CHECK(shop.json({"info", "other.weave"}).at("card_sha256") == info.at("card_sha256"));
    }
}

TEST_CASE("a card that was written the other way round is read that way") {
    const Workshop shop;
    shop.must({"preset", "twill", "up=3", "down=1", "-o", "t.weave"});
    const Json info = shop.json({"info", "t.weave"});
    const std::vector<std::string> way{"--pick-1", "top", "--end-1", "right", "--lifted", "white"};
    std::vector<std::string> write{"card", "t.weave", "-o", "t.png"},
        read{"import", "t.png", "-o", "back.weave"};
    write.insert(write.end(), way.begin(), way.end());
    read.insert(read.end(), way.begin(), way.end());
    shop.must(write);
    shop.must(read);
    CHECK(shop.json({"info", "back.weave"}).at("card_sha256") == info.at("card_sha256"));
}

TEST_CASE("a WIF file becomes a design") {
    const Workshop shop;
    shop.put("twill.wif",
             "[WIF]\nVersion=1.1\nDate=April 20, 1997\nDevelopers=wif@mhsoft.com\nSource Program=test\n"
             "[CONTENTS]\nWeaving=true\nWarp=true\nWeft=true\nThreading=true\nTieup=true\nTreadling=true\n"
             "[WEAVING]\nShafts=4\nTreadles=4\nRising Shed=true\n[WARP]\nThreads=4\n[WEFT]\nThreads=4\n"
             "[THREADING]\n1=1\n2=2\n3=3\n4=4\n[TIEUP]\n1=1,2\n2=2,3\n3=3,4\n4=4,1\n[TREADLING]\n1=1\n2=2\n3="
             "3\n4=4\n");
    const Json answer = shop.json({"import", "twill.wif", "-o", "w.weave"});
    CHECK(answer.at("picks") == 4);
    CHECK(answer.at("ends") == 4);
    CHECK(answer.at("warnings").is_array());
    shop.put("twill.txt", shop.get("twill.wif"));  // it is known by what is in it
    CHECK(shop.json({"import", "twill.txt", "-o", "t.weave"}).at("picks") == 4);
    const CardImage card = card_of(shop, "w.weave");
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) CHECK(card.weft_over(i, j) == !(j == i || j == (i + 1) % 4));
}

TEST_CASE("an accepted flip changes one pixel, its own, and a second one changes it back") {
    const Workshop shop;
    shop.must({"preset", "satin", "-o", "s.weave"});
    const CardImage before = card_of(shop, "s.weave");
    check_answer(shop.json({"flip", "s.weave", "--pick", "2", "--end", "4", "-o", "f.weave"}), "f.weave");
    const std::vector<std::pair<std::size_t, std::size_t>> one{{2, 4}};
    CHECK(differing(before, card_of(shop, "f.weave")) == one);
    shop.must({"flip", "f.weave", "--pick", "2", "--end", "4", "-o", "f.weave"});
    CHECK(differing(before, card_of(shop, "f.weave")).empty());
}

TEST_CASE("a flip of a crossing that was flipped before neither loses nor revives another one") {
    const Workshop shop;
    const std::string stack = R"({"format": "weave", "version": 1, "root": "s", "blocks": {"s":
        {"kind": "stacks", "stacks": [["T0 P0 T1 P1"]]}}})";
    shop.put("s.weave", stack);
    const std::pair<std::size_t, std::size_t> places[]{{2, 2}, {1, 2}, {1, 1}, {2, 2}};
    for (const auto& [pick, end] : places) {
        const CardImage before = card_of(shop, "s.weave");
        shop.must({"flip", "s.weave", "--pick", std::to_string(pick), "--end", std::to_string(end), "-o", "s.weave"});
        const std::vector<std::pair<std::size_t, std::size_t>> own{{pick, end}};
        CHECK(differing(before, card_of(shop, "s.weave")) == own);
    }
    // The first flip of this file keeps that of pick 2 and end 2 from being made, and goes on to do so.
    shop.put("t.weave", R"({"format": "weave", "version": 1, "root": "t", "blocks": {"t": {"kind": "stacks",
        "stacks": [["P1~ P2 P0 T1 T0"], ["T2~ P1 P0~ - P2 -"]], "flips": [
            {"pick": 0, "end": 0, "weft": "under"}, {"pick": 1, "end": 2, "weft": "over"},
            {"pick": 1, "end": 1, "weft": "under"}, {"pick": 2, "end": 1, "weft": "under"},
            {"pick": 0, "end": 2, "weft": "over"}]}}})");
    const auto card = [&](const std::string& design) {
        CHECK(shop.run({"card", design, "-o", "card.bmp"}).complaints().size() == 1);
        return weave::read_bitmap(shop.get("card.bmp")).value().card;
    };
    CHECK(shop.run({"flip", "t.weave", "--pick", "1", "--end", "1", "-o", "f.weave"}).exit == 0);
    const std::vector<std::pair<std::size_t, std::size_t>> own{{1, 1}};
    CHECK(differing(card("t.weave"), card("f.weave")) == own);
}

TEST_CASE("a flip of one crossing among 400 million is made without laying the cloth out") {
    const Workshop shop;
    shop.must({"preset", "plain", "-o", "p.weave"});
    shop.must({"tile", "p.weave", "--x", "10000", "--y", "10000", "-o", "big.weave"});
    const auto flips_of = [&] {
        return weave::parse_json(shop.get("f.weave"))->at("blocks").at("plain-tiled").at("flips");
    };
    const std::vector<std::string> flip{"flip", "big.weave", "--pick", "20000", "--end", "7", "-o", "f.weave"};
    check_answer(shop.json(flip), "f.weave");
    const Json there{{"pick", 19999}, {"end", 6}, {"weft", "under"}};
    CHECK(flips_of() == Json::array({there}));
    shop.must({"flip", "f.weave", "--pick", "20000", "--end", "7", "-o", "f.weave"});
    const Json back{{"pick", 19999}, {"end", 6}, {"weft", "over"}};
    CHECK(flips_of() == Json::array({back}));
    shop.refused({"flip", "big.weave", "--pick", "1", "--end", "20001", "-o", "new.weave"}, 3,
                 {"big.weave", "no crossing of pick 1 and end 20001", "20000 picks and 20000 ends"});
}

TEST_CASE("a flip tells of the flips that the design lost before, once") {
    const Workshop shop;
    shop.must({"preset", "twill", "-o", "t.weave"});
    Json document = *weave::parse_json(shop.get("t.weave"));
    document["blocks"]["twill"]["flips"] = Json::array({{{"pick", 98}, {"end", 0}, {"weft", "over"}}});
    shop.put("t.weave", document.dump());
    const Ended flipped = shop.run({"flip", "t.weave", "--pick", "1", "--end", "1", "-o", "f.weave"});
    CHECK(flipped.exit == 0);
    const std::string lost = "a flip of block 'twill' no longer applies: there is no crossing of pick 99 and end 1: "
                             "the block has 4 picks and 4 ends";
    CHECK(flipped.complaints() == std::vector<std::string>{"weave: f.weave: " + lost});
    const Json kept = weave::parse_json(shop.get("f.weave"))->at("blocks").at("twill").at("flips");
    CHECK(kept.size() == 2);
}

TEST_CASE("a flip that was refused once is lost no longer once its crossing lies as asked") {
    const Workshop shop;
    shop.put("z.weave", R"({"format": "weave", "version": 1, "root": "a", "blocks": {"a": {"kind": "stacks",
        "stacks": [["T0 P0 T1 P1"]], "flips": [{"pick": 0, "end": 1, "weft": "over"},
        {"pick": 1, "end": 1, "weft": "over"}]}}})");
    CHECK(shop.run({"info", "z.weave"}).complaints().size() == 1);
    CHECK(shop.must({"flip", "z.weave", "--pick", "1", "--end", "2", "-o", "z3.weave"}).complaints().empty());
    CHECK(shop.must({"info", "z3.weave"}).complaints().empty());
    CHECK(shop.json({"info", "z3.weave"}).at("lost_flips") == 0);
}

TEST_CASE("a flip with other yarns in the way is refused with 1, names them, and writes nothing") {
    const Workshop shop;
    shop.must({"preset", "multi-layer", "-o", "m.weave"});
    const CardImage card = card_of(shop, "m.weave");
    std::size_t refusals = 0;
    for (std::size_t pick = 1; pick <= card.picks(); ++pick)
        for (std::size_t end = 1; end <= card.ends(); ++end) {
            const std::vector<std::string> call{"flip",  "m.weave",           "--pick", std::to_string(pick),
                                                "--end", std::to_string(end), "-o",     "new.weave"};
            const Ended ended = shop.run(call);
            if (ended.exit == 0) {
                const std::vector<std::pair<std::size_t, std::size_t>> one{{pick, end}};
                CHECK(differing(card, card_of(shop, "new.weave")) == one);
                std::filesystem::remove(shop.path("new.weave"));
                continue;
            }
            ++refusals;
            const std::string line = shop.refused(
                call, 1,
                {"m.weave", "pick " + std::to_string(pick), "end " + std::to_string(end), "in the way"});
            CHECK(!shop.has("new.weave"));
            std::vector<std::string> ask = call;
            const Json told = shop.json(ask, 1);
            CHECK(told.at("error").at("kind") == "invalid");
            std::size_t named = 0;
            for (const char* yarn : {"pick", "end"})
                for (const Json& number : told.at(yarn + std::string("s"))) {
                    CHECK(line.substr(line.find("in the way")).find(yarn + (" " + number.dump())) !=
                          std::string::npos);
                    ++named;
                }
            CHECK(named > 0);
            CHECK(named == 1U + static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')));
        }
    CHECK(refusals > 0);
    CHECK(refusals < card.picks() * card.ends());
    shop.refused({"flip", "m.weave", "--pick", "999", "--end", "1", "-o", "new.weave"}, 3, {"999"});
}

TEST_CASE("renumber changes the card's rows of that row alone, as the order says") {
    const Workshop shop;
    shop.must({"preset", "multi-layer", "weave=1", "-o", "m.weave"});
    const Json info = shop.json({"info", "m.weave"});
    REQUIRE(info.at("picks") == 2 * info.at("rows").get<std::size_t>());
    const CardImage before = card_of(shop, "m.weave");
    check_answer(shop.json({"renumber", "m.weave", "--row", "1", "--order", "1,0", "-o", "r.weave"}),
                 "r.weave");
    const CardImage after = card_of(shop, "r.weave");
    for (std::size_t i = 0; i < before.picks(); ++i) {
        const std::size_t from = i == 2 ? 3 : i == 3 ? 2 : i;
        INFO("pick " << i + 1);
        CHECK(std::equal(after.row(i).begin(), after.row(i).end(), before.row(from).begin()));
    }
    CHECK(!differing(before, after).empty());
    shop.must({"renumber", "m.weave", "--column", "0", "--order", "1,0", "-o", "c.weave"});
    const CardImage columns = card_of(shop, "c.weave").transposed(), were = before.transposed();
    CHECK(std::equal(columns.row(0).begin(), columns.row(0).end(), were.row(1).begin()));
    CHECK(std::equal(columns.row(1).begin(), columns.row(1).end(), were.row(0).begin()));
    shop.refused({"renumber", "m.weave", "--row", "99", "--order", "1,0", "-o", "new.weave"}, 3, {"row 99"});
    shop.refused({"renumber", "m.weave", "--row", "1", "--order", "1,1", "-o", "new.weave"}, 3,
                 {"row 1", "once"});
    shop.refused({"renumber", "m.weave", "--row", "1", "--order", "0,1,2", "-o", "new.weave"}, 3,
                 {"2 picks"});
}

TEST_CASE("the samples are listed one a line, and each can be written") {
    const Workshop shop;
    const Ended list = shop.must({"samples"});
    const Json described = shop.json({"samples"}).at("samples");
    std::string names;
    for (const Json& one : described) {
        names += one.at("name").get<std::string>() + "\n";
        for (const char* key : {"title", "about", "loom"}) CHECK(!one.at(key).get<std::string>().empty());
    }
    std::istringstream lines(list.out);
    for (const Json& one : described) {
        std::string line;
        std::getline(lines, line);
        INFO(line);
        const auto about = one.at("about").get<std::string>();
        CHECK(line.rfind(one.at("name").get<std::string>() + " ", 0) == 0);
        CHECK(line.substr(line.find_first_not_of(' ', line.find(' '))) == about.substr(0, about.find(". ")));
    }
    CHECK(list.out.find("NAME -o FILE.weave") != std::string::npos);
    for (const char* name :
         {"plain", "twill-2-2", "satin-5", "satin-e", "twill-g", "three-colour-stencil", "layer-to-layer",
          "angle-interlock-a", "angle-interlock-b", "orthogonal", "hexagon-tubes", "tl013-wrong",
          "tl013-corrected", "pocket", "i-beam", "shoe-baby", "shoe-toddler", "shoe-adult"}) {
        INFO(name);
        CHECK(("\n" + names).find("\n" + std::string(name) + "\n") != std::string::npos);
    }
    check_answer(shop.json({"samples", "plain", "-o", "plain.weave"}), "plain.weave");
}

TEST_CASE("the issue's closing commands: a shoe from the library to its card") {
    const Workshop shop;
    shop.must({"samples", "shoe-adult", "-o", "shoe.weave"});
    shop.must({"check", "shoe.weave", "--loom", loom("ep-2688")});
    shop.must({"card", "shoe.weave", "-o", "shoe.png"});
    const Json info = shop.json({"info", "shoe.weave"});
    CHECK(info.at("blocks") >= 68);
    const weave::Result<weave::CardFromBitmap> card = weave::read_bitmap(shop.get("shoe.png"));
    REQUIRE(card);
    CHECK(card->card.sha256() == info.at("card_sha256").get<std::string>());
    CHECK(shop.names() == std::set<std::string>{"shoe.weave", "shoe.png"});
}

TEST_CASE("a design is made from slices written as text, with the yarns of another") {
    const Workshop shop;
    shop.must({"samples", "satin-e", "-o", "yarns.weave"});
    shop.put("plain.txt", "P0 T0\nT0 P0\n\nT0 P0\nP0 T0\n");
    CHECK(shop.must({"slices", "plain.txt", "-o", "plain.weave"}).out == "plain.weave: 2 picks and 2 ends in 2 rows and 2 columns, 2 high\n");
    const Json plain = shop.json({"info", "plain.weave"});
    shop.must({"slices", "plain.txt", "--yarns", "yarns.weave", "--title", "Plain", "-o", "other.weave"});
    const Json other = Json::parse(shop.get("other.weave")), source = Json::parse(shop.get("yarns.weave"));
    CHECK(other.at("title") == "Plain");
    for (const char* part : {"warp", "weft", "scene"}) CHECK(other.at(part) == source.at(part));
    CHECK(shop.json({"info", "other.weave"}).at("card_sha256") == plain.at("card_sha256"));
    shop.put("bad.txt", "P0 T0\nT0 P0\n\nT0 X\n");
    shop.refused({"slices", "bad.txt", "-o", "bad.weave"}, 3, {"bad.txt: ", "line 4"});
    shop.put("uneven.txt", "P0 T0\nT0 P0\n\nT0 P0\n");
    CHECK(shop.refused({"slices", "uneven.txt", "-o", "bad.weave"}, 3, {"uneven.txt"}).find("slice") != std::string::npos);
    shop.refused({"slices", "plain.txt", "--dots", "both", "-o", "bad.weave"}, 2, {"--dots"});
    shop.refused({"slices", "plain.txt", "--yarns", "none.weave", "-o", "bad.weave"}, 3, {"none.weave"});
}
